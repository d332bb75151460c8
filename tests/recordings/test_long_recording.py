"""A recording processed in blocks gives the bits of the whole one, and an interrupted run continues."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.io.dca1000 import write_bin
from mmweaver.io.result_folder import plain
from mmweaver.recordings import long_recording
from mmweaver.recordings.processing import process_recording
from tests.recordings.test_plausibility import RADAR, room

FRAMES = 50


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Fifty frames with two packets of zeros."""
    path = tmp_path_factory.mktemp("long") / "long.bin"
    write_bin(path, room(RADAR, FRAMES), counts_per_unit=1.0)
    data = bytearray(path.read_bytes())
    for number in (300, 1000):
        data[number * 1456 : (number + 1) * 1456] = bytes(1456)
    path.write_bytes(data)
    return path


@pytest.fixture
def blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of 20 frames for any recording."""
    monkeypatch.setattr(long_recording, "BLOCK_BYTES", 1.0)
    monkeypatch.setattr(long_recording, "LONG_BYTES", 1.0)


def saved(out: Path) -> dict[str, np.ndarray]:
    arrays = {}
    for name in ("radar", "points", "analysis"):
        with np.load(out / f"{name}.npz") as held:
            arrays |= {f"{name}.{key}": held[key] for key in held}
    return arrays


@pytest.mark.parametrize("static_removal", ["none", "auto"])
def test_blocks_give_the_bits_of_the_whole(recording: Path, tmp_path: Path, blocks: None, static_removal: str):
    whole = process_recording(recording, RADAR, static_removal=static_removal)
    whole.save(tmp_path / "whole", pictures=False)
    parts = process_recording(recording, RADAR, static_removal=static_removal, work=tmp_path / "work")
    parts.save(tmp_path / "parts", pictures=False)
    one, other = saved(tmp_path / "whole"), saved(tmp_path / "parts")
    assert set(one) == set(other)
    for name, array in one.items():
        assert array.tobytes() == other[name].tobytes(), name
    assert (tmp_path / "whole" / "radar.npz").read_bytes() == (tmp_path / "parts" / "radar.npz").read_bytes()
    assert plain(whole.meta["analysis"]) == plain(parts.meta["analysis"])
    assert [text for text in whole.meta["warnings"] if "lost" in text] == parts.meta["warnings"][-1:]


def test_an_interrupted_run_continues(recording: Path, tmp_path: Path, blocks: None):
    done: list[int] = []

    def interrupt(frames: int, total: int) -> None:
        done.append(frames)
        if len(done) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        process_recording(recording, RADAR, work=tmp_path / "work", progress=interrupt)
    again = process_recording(recording, RADAR, work=tmp_path / "work")
    assert (done, again.resumed) == ([20, 40], 2)
    assert np.array_equal(again.cube.values[:], process_recording(recording, RADAR).cube.values)
    other = process_recording(recording, RADAR, work=tmp_path / "work", static_removal="mean_chirp")
    assert other.resumed == 0  # blocks of other settings are not used
