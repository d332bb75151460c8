"""The photo of a capture folder."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import CameraIntrinsics
from mmweaver.scene.photo.capture_photo import photo_folder, photo_times_s, read_capture_photo
from tests.captures import START_S, write_camera

LENS = CameraIntrinsics(fx=60.0, fy=60.0, cx=31.5, cy=23.5, width=64, height=48)
WIDE = (96, 128)  # rows, columns of the colour picture
DEPTHS_M = [np.full((48, 64), depth) for depth in (2.0, 3.0)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Depth of 2 m and 3 m; the colour picture is red left of its middle column, blue right of it."""
    picture = np.zeros((*WIDE, 3), np.uint8)
    picture[:, :64, 0], picture[:, 64:, 2] = 250, 250
    depths = [depth.copy() for depth in DEPTHS_M]
    depths[1][:10] = 0
    write_camera(tmp_path / "realsense", LENS, depths, [picture, picture])
    return tmp_path


def test_a_photo_with_its_depth(folder: Path):
    found = read_capture_photo(folder, 1)
    assert found.folder == folder / "realsense"
    assert found.photo.intrinsics == LENS
    assert np.isnan(found.photo.depth_m[:10]).all()
    assert found.photo.depth_m[20, 20] == pytest.approx(3.0)
    assert len(found.assumptions) == 2


@pytest.mark.parametrize(("index", "depth_m"), [(0, 2.0), (1, 3.0)])
def test_colours_are_reprojected_from_the_colour_camera(folder: Path, index: int, depth_m: float):
    """The edge at the colour camera's middle lies 59 mm to the right of the depth camera's, so 1.8 or 1.2 columns."""
    red = read_capture_photo(folder, index).photo.rgb[30, :, 0] > 120
    edge = int(np.argmin(red))
    assert edge == pytest.approx(LENS.cx + 0.059 * LENS.fx / depth_m, abs=1)


def test_a_camera_that_was_turned(folder: Path):
    """The recorder turns both pictures clockwise and keeps the intrinsics of the unturned ones."""
    import zstandard

    from tests.captures import avi_of

    depth = 2.0 + 0.01 * np.arange(64)[None, :] + np.zeros((48, 1))
    picture = np.zeros((*WIDE, 3), np.uint8)
    raw = np.rot90((1e3 * depth).round().astype("<u2"), -1)
    camera = folder / "realsense"
    (camera / "depth.zst").write_bytes(zstandard.ZstdCompressor().compress(np.ascontiguousarray(raw).tobytes()))
    (camera / "color.avi").write_bytes(avi_of([np.ascontiguousarray(np.rot90(picture, -1))]))
    (folder / "config.toml").write_text("[hardware.realsense]\nrotate = true\n")
    photo = read_capture_photo(folder).photo
    assert photo.depth_m.shape == (64, 48)
    assert photo.depth_m[10, 5] == pytest.approx(2.0 + 0.01 * 10)
    assert (photo.intrinsics.width, photo.intrinsics.height) == (48, 64)
    assert (photo.intrinsics.cx, photo.intrinsics.cy) == (23.5, 31.5)


def test_times_of_the_recorders_clock(folder: Path):
    times_s = photo_times_s(folder / "realsense")
    assert times_s == pytest.approx(START_S + 0.02 + np.arange(9) / 15, abs=1e-3)
    entries = [{"timestamp": 1500.0}, {"timestamp": 1566.0}]
    (folder / "realsense" / "depth_metadata.json").write_text(json.dumps(entries))
    assert photo_times_s(folder / "realsense").tolist() == [1.5, 1.566]
    for content in ("[]", '[{"frame_num": 1}]', "{", '[{"timestamp": "soon"}]'):
        (folder / "realsense" / "depth_metadata.json").write_text(content)
        with pytest.raises(InputError, match="depth_metadata"):
            photo_times_s(folder / "realsense")


def test_broken_folders(folder: Path, tmp_path: Path):
    camera = folder / "realsense"
    (tmp_path / "empty" / "deep").mkdir(parents=True)
    assert photo_folder(tmp_path / "empty" / "deep") is None
    for place, index, message in (
        (folder, 2, "holds 2 photos"),
        (tmp_path / "empty" / "none", 0, "does not exist"),
        (tmp_path / "empty" / "deep", 0, "no RealSense"),
    ):
        with pytest.raises(InputError, match=message):
            read_capture_photo(place, index)
    whole, config = (camera / "depth.zst").read_bytes(), json.loads((camera / "depth_config.json").read_text())
    for name, content, message in (
        ("depth.zst", whole[: len(whole) // 2], r"depth\.zst"),
        ("depth.zst", b"rubbish, not compressed", r"depth\.zst"),
        ("depth_config.json", json.dumps({**config, "depth_units": 1.0}).encode(), "depth_units"),
        ("depth_config.json", json.dumps({**config, "intrinsics": {"fx": 3}}).encode(), "lacks intrinsics"),
        ("depth_config.json", b"no json", "no JSON"),
    ):
        good = (camera / name).read_bytes()
        (camera / name).write_bytes(content)
        with pytest.raises(InputError, match=message):
            read_capture_photo(folder, 1)
        (camera / name).write_bytes(good)
