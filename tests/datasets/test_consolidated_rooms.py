"""The last step of a data set writes two files; a kill between them is made good by the next run."""

import hashlib
from pathlib import Path

from mmweaver.core.checksums import SUMS_FILE, read_sums
from mmweaver.datasets.generate_rooms import METADATA, consolidate_rooms


def test_a_kill_between_the_two_files_is_made_good(tmp_path: Path):
    for place in (tmp_path, tmp_path / "office_000", tmp_path / "range"):
        place.mkdir(exist_ok=True)
        (place / METADATA).write_text('{"zarr_format": 3}')
    before = f"{hashlib.sha256((tmp_path / METADATA).read_bytes()).hexdigest()}  {METADATA}\n"
    (tmp_path / SUMS_FILE).write_text(before)
    for _ in range(2):
        consolidate_rooms(tmp_path, ["office_000"], ["range"])
        digest = hashlib.sha256((tmp_path / METADATA).read_bytes()).hexdigest()
        assert read_sums(tmp_path) == {METADATA: digest}
        (tmp_path / SUMS_FILE).write_text(before)  # as the kill leaves it
