"""The root of a data set, whatever moment a process is killed at."""

import contextlib
from pathlib import Path

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.checksums import SUMS_FILE, damages, read_sums
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.generate_rooms import open_dataset

pytest.importorskip("zarr")
PLAN = DatasetPlan(kinds=("office",), lightings=("day",), num_layouts=1, sequences_a_room=1, num_frames=2)


class _Killed(BaseException):
    """The process ends here."""


def test_checksums_of_the_root_name_only_what_is_there_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """They come last: a reader that finds them finds all that they name; run again, the rest is made."""
    rename = Path.rename
    killed_at, unfinished = 0, True
    while unfinished:
        killed_at += 1
        folder, count = tmp_path / f"killed at {killed_at}", 0

        def renamed(source: Path, target: Path, folder: Path = folder, killed_at: int = killed_at) -> Path:
            nonlocal count
            count += Path(target).parent == folder
            if count >= killed_at:
                raise _Killed
            return rename(source, target)

        with monkeypatch.context() as patch, contextlib.suppress(_Killed):
            patch.setattr(Path, "rename", renamed)
            open_dataset(folder, PLAN, AWR1843)
            unfinished = False
        assert damages(folder) == []
        assert (read_sums(folder) is None) == unfinished
        open_dataset(folder, PLAN, AWR1843)
        assert damages(folder) == []
        assert (folder / SUMS_FILE).is_file()
    assert killed_at > 4
