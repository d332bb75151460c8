"""Every format is written by its name, read back by its own library, or refused in one line."""

import importlib.util
import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.datasets.export import export_result
from mmweaver.datasets.robotics import ros_axes
from mmweaver.io.stored_result import StoredResult


def has(package: str) -> None:
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} is not installed")


def test_matlab(result: StoredResult, result_folder: Path, tmp_path: Path):
    from scipy.io import loadmat

    export_result(result_folder, "mat", tmp_path / "out")
    read = loadmat(tmp_path / "out" / "result.mat")
    np.testing.assert_array_equal(read["cube"], result.cube.values)
    np.testing.assert_array_equal(read["range_m"][0], result.cube.grid.range_m)
    np.testing.assert_array_equal(read["points"][:, 0], result.points.frame + 1)
    np.testing.assert_allclose(read["joints_m"][0], result.poses[0].joints_m, atol=1e-6)
    assert read["text"][0] == "a person waves"


def test_netcdf(result: StoredResult, result_folder: Path, tmp_path: Path):
    has("xarray")
    import xarray

    export_result(result_folder, "netcdf", tmp_path / "out")
    with xarray.open_dataset(tmp_path / "out" / "result.nc", engine="scipy", decode_times=False) as read:
        values = read.cube_real.values + 1j * read.cube_imag.values
        np.testing.assert_array_equal(values, result.cube.values)
        near = read.sel(range=2.0, method="nearest")
        assert abs(float(near.range) - 2.0) < 0.05
        np.testing.assert_allclose(read.joints.values[0], result.poses[0].joints_m, atol=1e-6)


@pytest.mark.filterwarnings("error")
def test_zarr(result: StoredResult, result_folder: Path, tmp_path: Path):
    has("xarray")
    has("zarr")
    import xarray

    export_result(result_folder, "zarr", tmp_path / "out")
    with xarray.open_zarr(tmp_path / "out" / "result.zarr", decode_times=False) as read:
        np.testing.assert_array_equal(read.cube.values, result.cube.values)
        assert abs(float(read.sel(range=2.0, method="nearest").range) - 2.0) < 0.05
        assert read.attrs["joint_names"][0] == "pelvis"


def test_ros2(result: StoredResult, result_folder: Path, tmp_path: Path):
    has("rosbags")
    from rosbags.highlevel import AnyReader

    export_result(result_folder, "ros2", tmp_path / "out")
    with AnyReader([tmp_path / "out" / "bag"]) as bag:
        messages: list[tuple[str, int, Any]] = [
            (one.topic, stamp, bag.deserialize(data, one.msgtype)) for one, stamp, data in bag.messages()
        ]
    clouds = [(stamp, said) for topic, stamp, said in messages if topic == "/radar/points"]
    assert len(clouds) == 4
    assert clouds[1][0] == round(1e9 * result.cube.grid.frame_time_s[1])
    first = np.frombuffer(clouds[0][1].data.tobytes(), "<f4").reshape(clouds[0][1].width, -1)
    own = result.points.frame == 0
    np.testing.assert_allclose(first[:, 0], result.points.y_m[own], rtol=1e-6)
    np.testing.assert_allclose(first[:, 1], -result.points.x_m[own], rtol=1e-6)
    assert [field.name for field in clouds[0][1].fields] == ["x", "y", "z", "velocity", "snr_db"]
    poses = next(said for topic, _, said in messages if topic == "/radar/skeleton_0")
    place = poses.poses[0].position
    np.testing.assert_allclose([place.x, place.y, place.z], ros_axes(result.poses[0].joints_m[0, 0]), atol=1e-6)
    power = next(said for topic, _, said in messages if topic == "/radar/range_doppler_db")
    assert [one.size for one in power.layout.dim] == list(result.cube.values.shape[1:3])


def test_mcap(result: StoredResult, result_folder: Path, tmp_path: Path):
    has("foxglove")
    mcap = pytest.importorskip("mcap.reader", reason="mcap is not installed")

    export_result(result_folder, "mcap", tmp_path / "out")
    with (tmp_path / "out" / "result.mcap").open("rb") as file:
        seen = [
            (channel.topic, schema.name, message.log_time)
            for schema, channel, message in mcap.make_reader(file).iter_messages()
        ]
    assert sum(topic == "/radar/points" for topic, _, _ in seen) == 4
    assert {schema for _, schema, _ in seen} == {"foxglove.PointCloud", "foxglove.SceneUpdate"}
    assert max(time for _, _, time in seen) == round(1e9 * result.cube.grid.frame_time_s[-1])


@pytest.mark.parametrize("kind", ["mp4", "webm"])
def test_videos(result_folder: Path, tmp_path: Path, kind: str):
    has("av")
    import av

    export_result(result_folder, kind, tmp_path / "out")
    with av.open(str(tmp_path / "out" / f"result.{kind}")) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
        assert float(container.streams.video[0].average_rate or 0) == pytest.approx(2, rel=0.1)
    assert len(frames) == 4
    assert frames[0].std() > 10


def test_the_command_exports_many(result_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["export", str(result_folder.parent), "--to", "radhar", "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out" / result_folder.name / "radhar.txt").is_file()
    assert "points as RadHAR's text" in capsys.readouterr().out
    assert main(["export"]) == 0
    assert "hupr" in capsys.readouterr().out
    assert main(["export", "--json"]) == 0
    assert {one["format"]: one["needs_samples"] for one in json.loads(capsys.readouterr().out)}["hupr"] is True


@pytest.mark.parametrize(
    "arguments",
    [["--to", "excel", "--out", "x"], ["--out", "x"], ["--to", "mat"], []],
    ids=["format", "to", "out", "none"],
)
def test_what_is_missing_is_said(
    arguments: list[str],
    result_folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.chdir(tmp_path)
    assert main(["export", str(result_folder), *arguments]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_two_radars_at_a_right_angle_as_hupr_has_them(result_folder: Path, tmp_path: Path):
    def two_radars(name: str, roll_deg: float) -> Path:
        for number, roll in ((1, 0.0), (2, roll_deg)):
            folder = shutil.copytree(result_folder, tmp_path / name / f"radar_{number}")
            (folder / "SHA256SUMS").unlink()
            meta = json.loads((folder / "meta.json").read_text())
            (folder / "meta.json").write_text(json.dumps({**meta, "radar_pose": {"roll_deg": roll}}))
        return tmp_path / name

    both = two_radars("both", 90.0)
    assert main(["export", str(both), "--to", "hupr", "--out", str(tmp_path / "hupr")]) == 0
    for name in ("hori", "vert"):
        assert np.load(tmp_path / "hupr" / name / "000000001.npy").shape == (16, 64, 64, 8)
    assert np.load(tmp_path / "hupr" / "joints_m.npy").shape == (4, 1, 14, 3)
    assert main(["export", str(both), "--to", "mmmesh", "--out", str(tmp_path / "mmmesh")]) == 0
    assert (tmp_path / "mmmesh" / "radar_2" / "points").is_dir()
    with pytest.raises(InputError, match="rolled by 90"):
        export_result(two_radars("level", 0.0), "hupr", tmp_path / "none")


def test_rerun(result_folder: Path, tmp_path: Path):
    has("rerun")
    export_result(result_folder, "rerun", tmp_path / "out")
    command = [sys.executable, "-m", "rerun_cli", "rrd", "verify", str(tmp_path / "out" / "result.rrd")]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    assert "without error" in found.stdout + found.stderr
