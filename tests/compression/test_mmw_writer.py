from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression.long_recording import MmwWriter
from mmweaver.compression.mmw_codec import describe_mmw, read_cube
from mmweaver.core.errors import InputError
from tests.compression.echoes import SMALL, error_db
from tests.compression.test_mmw_codec import plain_cube

RADAR = replace(SMALL, num_loops=2, num_range_bins=4)


def piece(first: int, num_frames: int):
    cube = plain_cube(RADAR, num_frames)
    return replace(cube, grid=replace(cube.grid, frame_time_s=cube.grid.frame_time_s + first * RADAR.frame_period_s))


def test_pieces_are_one_recording(tmp_path: Path):
    path = tmp_path / "a.mmw"
    with MmwWriter(path) as writer:
        sizes = [writer.append(piece(0, 10), num_bytes=900), writer.append(piece(10, 5), quality_db=20.0)]
    with MmwWriter(path, append=True) as writer:
        sizes.append(writer.append(piece(15, 10), num_bytes=900))
    again = read_cube(path)
    assert again.grid.frame_time_s == pytest.approx(np.arange(25) * RADAR.frame_period_s)
    assert sum(sizes) <= path.stat().st_size < sum(sizes) + 120
    assert error_db(again.values[10:15], plain_cube(RADAR, 5).values) < -15
    assert len(read_cube(path, slice(12, 20)).values) == 8


@pytest.mark.usefixtures("stored_exactly")
def test_a_record_cut_short_is_replaced(tmp_path: Path):
    path = tmp_path / "a.mmw"
    with MmwWriter(path) as writer:
        for first in (0, 4):
            writer.append(piece(first, 4), num_bytes=700)
    whole = read_cube(path)
    path.write_bytes(path.read_bytes()[:-30])
    assert describe_mmw(path)["shape"][0] == 4
    with MmwWriter(path, append=True) as writer:
        writer.append(piece(4, 4), num_bytes=700)
    assert describe_mmw(path)["cut_short_bytes"] == 0
    assert np.array_equal(read_cube(path).values, whole.values)


@pytest.mark.usefixtures("stored_exactly")
def test_what_does_not_fit_is_refused(tmp_path: Path):
    path = tmp_path / "a.mmw"
    with MmwWriter(path) as writer:
        writer.append(piece(0, 3), num_bytes=900)
    with pytest.raises(InputError, match="exists"):
        MmwWriter(path)
    before = path.read_bytes()
    with MmwWriter(path, append=True) as writer, pytest.raises(InputError, match="another radar"):
        writer.append(plain_cube(SMALL, 1), num_bytes=800)
    assert path.read_bytes() == before
    (tmp_path / "b.mmw").write_bytes((Path(__file__).parents[1] / "golden" / "version_1.mmw").read_bytes())
    with pytest.raises(InputError, match="version 1"):
        MmwWriter(tmp_path / "b.mmw", append=True)


@pytest.mark.parametrize("version", [3, 4])
def test_a_file_of_an_older_version_is_continued(tmp_path: Path, version: int):
    path = tmp_path / "old.mmw"
    path.write_bytes((Path(__file__).parents[1] / "golden" / f"version_{version}.mmw").read_bytes())
    before = read_cube(path)
    again = replace(
        before, values=before.values[:1], grid=replace(before.grid, frame_time_s=before.grid.frame_time_s[:1])
    )
    with MmwWriter(path, append=True) as writer:
        writer.append(writer.following(again, 0), num_bytes=1500, effort="fast")
    after = read_cube(path)
    np.testing.assert_array_equal(after.values[:-1], before.values)
    error = np.sum(np.abs(after.values[-1] - before.values[0]) ** 2) / np.sum(np.abs(before.values[0]) ** 2)
    assert error < 0.1
