from pathlib import Path

import numpy as np

from mmweaver.core.seeding import stream
from studies.fields import lossless_codecs
from studies.fields.field_signals import two_people_radar


def test_a_row_has_bytes_and_share(tmp_path: Path, monkeypatch):
    def noise(_data: Path, folder: Path):
        words = stream(0, "words").integers(-100, 100, size=2 * 8 * 128 * 8)
        (folder / "a.bin").write_bytes(words.astype("<i2").tobytes())
        return folder / "a.bin", two_people_radar(num_loops=8)

    monkeypatch.setitem(lossless_codecs.RECORDINGS, "noise", noise)
    row = lossless_codecs.codec_row("mmwl", "noise", tmp_path)
    assert row["size"]["raw_bytes"] == 4 * 8 * 128 * 8
    assert np.log2(200) / 16 < row["metrics"]["share"]["value"] < 0.6  # no less than the entropy
