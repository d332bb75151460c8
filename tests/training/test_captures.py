"""A user's capture folders: reading, refusals, noise and static clutter."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.io.npz_files import read_poses_npz, read_radar_npz, write_radar_npz
from mmweaver.scene.photo_files import sample_photo
from mmweaver.training.captures import read_capture, rooms_of
from mmweaver.weaver.front_door import Weaver


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of mmweaver generate."""
    out = tmp_path_factory.mktemp("capture") / "walk"
    weaver = Weaver("physics")
    weaver.generate(weaver.sample_room(), "a person walks towards the radar", frames=8, seed=3).save(
        out, pictures=False
    )
    return out


def test_a_folder_of_generate(made: Path):
    one = read_capture(made)
    assert one.cube.values.shape[0] == 8
    assert one.pose is not None
    assert np.array_equal(one.photo.rgb, sample_photo()[0].rgb)
    (room,) = rooms_of([one])
    assert room.has_joints
    assert room.is_calibrated
    assert room.joints_m.shape == (1, 8, 22, 3)
    noise = AWR1843.noise_power_mw * 1.5 / AWR1843.num_samples * 1.5 / AWR1843.num_loops
    assert 10 * np.log10(room.noise_power / noise) == pytest.approx(0, abs=1.5)
    assert np.allclose(room.cube(0).values, one.cube.values * one.cube.scale)
    assert np.allclose(room.calibrated(2.0).static, 2 * room.static)


def test_a_recording_without_scale_and_joints(made: Path, tmp_path: Path):
    """What mmweaver process writes, with the photo in the folder above, which comes before any other."""
    cube = read_radar_npz(made / "radar.npz")
    folder = tmp_path / "room" / "take"
    folder.mkdir(parents=True)
    write_radar_npz(folder / "radar.npz", replace(cube, scale=float("nan")))
    (folder / "radar.json").write_text((made / "radar.json").read_text())
    with pytest.raises(InputError, match=r"no photo.*rgb\.png"):
        read_capture(folder)
    photo = sample_photo()[0]
    pixels = photo.rgb if photo.rgb.dtype == np.uint8 else np.round(255 * photo.rgb).astype(np.uint8)
    Image.fromarray(pixels).save(folder.parent / "rgb.png")
    np.save(folder.parent / "depth.npy", photo.depth_m)
    (room,) = rooms_of([read_capture(folder)])
    assert not room.is_calibrated
    assert not room.has_joints
    # people move and the room does not: the mean over frames is the room
    still = cube.values[:, :, AWR1843.num_loops // 2].mean(axis=0)
    assert np.allclose(room.static, still, rtol=1e-4, atol=1e-4 * np.abs(still).max())


def test_a_capture_folder_brings_its_own_photo(tmp_path: Path):
    pytest.importorskip("zstandard")
    from tests.captures import counts, radar_of_cfg, write_camera, write_radar

    lens = sample_photo()[0].intrinsics
    depth = np.full((lens.height, lens.width), 2.0)
    picture = np.full((lens.height, lens.width, 3), 120, np.uint8)
    write_radar(tmp_path / "capture" / "radar", counts(radar_of_cfg(tmp_path), 3))
    write_camera(tmp_path / "capture" / "camera", lens, [depth], [picture])
    one = read_capture(tmp_path / "capture")
    assert one.pose is None
    assert len(one.cube.values) == 3
    assert np.nanmedian(one.photo.depth_m) == pytest.approx(2.0, abs=0.01)


def test_inconsistent_captures_are_refused(made: Path, tmp_path: Path):
    with pytest.raises(InputError, match="not a capture folder"):
        read_capture(tmp_path)
    one = read_capture(made)
    other = replace(one, cube=replace(one.cube, config=replace(AWR1843, frame_period_s=0.2)))
    with pytest.raises(InputError, match="another radar"):
        rooms_of([one, other])
    late = tmp_path / "late"
    late.mkdir()
    for name in ("radar.npz", "radar.json", "meta.json", "pose.npz"):
        (late / name).write_bytes((made / name).read_bytes())
    from mmweaver.io.npz_files import write_pose_npz

    pose = read_poses_npz(late / "pose.npz")[0]
    write_pose_npz(late / "pose.npz", replace(pose, time_s=pose.time_s + 5.0))
    with pytest.raises(InputError, match=r"5\.00 to 5\.70 s"):
        read_capture(late)
