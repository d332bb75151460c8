"""Recordings that are offered on the command line."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.stream_folder import StreamFolder
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.points import point_cloud
from mmweaver.studio.recordings import check_offered, read_offered, read_recorded
from mmweaver.studio.service import Offered
from mmweaver.studio.sessions import Result
from tests import captures
from tests.io.point_clouds.test_read_points import XYZV, out_of_box


def offered(*paths: Path) -> Offered[Result]:
    for path in paths:
        check_offered(path)
    return Offered("recording", list(paths), read_offered)


def test_folders_and_files_by_name(tmp_path: Path):
    folder = tmp_path / "hall"
    folder.mkdir()
    config = captures.radar_of_cfg(folder)
    write_bin(folder / "adc_data.bin", captures.counts(config), counts_per_unit=1.0)
    (tmp_path / "log.dat").write_bytes(out_of_box(1, XYZV))
    found = offered(folder, tmp_path / "log.dat", folder)
    assert found.names == ["hall", "log.dat", "hall-2"]
    hall, log = found.get("hall"), found.get("log.dat")
    assert hall.cube is not None
    assert hall.cube.config.num_loops == config.num_loops
    assert hall.title.startswith("adc_data.bin")
    assert log.cube is None
    assert np.isclose(log.points.snr_db, 12.3).all()


def test_a_stream_is_one_recording(tmp_path: Path):
    cube = radar_cube(captures.counts(captures.radar_of_cfg(tmp_path)))
    poses = (PoseSequence(time_s=cube.grid.frame_time_s, joints_m=np.zeros((3, 22, 3)), height_m=1.7),)
    stream = StreamFolder(tmp_path / "live", {})
    for _ in range(2):
        stream.add(cube, point_cloud(cube), poses, None, {})
    stream.finish()
    live = offered(tmp_path / "live").get("live")
    assert live.cube is not None
    assert len(live.cube.values) == 2 * len(cube.values)


def test_what_is_none_is_said(tmp_path: Path):
    with pytest.raises(InputError, match="No such file"):
        offered(tmp_path / "none")
    assert read_recorded(tmp_path) is None
    with pytest.raises(InputError, match="holds no recording"):
        offered(tmp_path)
    for name, said in (("log.dat", "empty"), ("adc_data.bin", "with its .cfg")):
        (tmp_path / name).write_bytes(b"" if name == "log.dat" else b"12345678")
        with pytest.raises(InputError, match=said):
            offered(tmp_path / name)
    with pytest.raises(InputError, match="not known"):
        offered().get("/etc/passwd")
