"""The unit of a depth picture, its kind and its byte order follow from the room that it shows."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import normalized_coordinates
from mmweaver.core.records import CameraIntrinsics
from mmweaver.scene.depth_scale import (
    UNITS,
    depth_along_axis,
    depth_of_disparity,
    estimate_unit,
    is_ray_distance,
    is_rotated,
    refuse_swapped_bytes,
    rotated_by_three,
    unit_of_name,
)
from mmweaver.scene.photo.camera_file import d455_intrinsics, intrinsics_for, read_camera_file
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.read_photo import read_photo

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"


@pytest.fixture(scope="module")
def room() -> tuple[np.ndarray, CameraIntrinsics]:
    """Depth of the bundled room in metres, 0 in holes, and its camera."""
    photo, _ = sample_photo()
    return np.nan_to_num(photo.depth_m), photo.intrinsics


@pytest.mark.parametrize("name", ["mm", "kitti"])
def test_unit_follows_from_the_room(room: tuple[np.ndarray, CameraIntrinsics], name: str):
    depth_m, camera = room
    found = estimate_unit(np.rint(depth_m / UNITS[name][0]).astype(np.uint16), camera, "depth.png")
    assert found.unit_m == pytest.approx(UNITS[name][0])
    assert f"--depth-unit {name}" in found.note


def test_counts_of_a_kinect_times_five_are_tums(room: tuple[np.ndarray, CameraIntrinsics]):
    depth_m, camera = room
    counts = (np.rint(1000 * depth_m) * 5).astype(np.uint16)
    assert estimate_unit(counts, camera, "depth.png").unit_m == pytest.approx(0.0002)


def test_units_that_rooms_cannot_tell_apart_are_offered(room: tuple[np.ndarray, CameraIntrinsics]):
    depth_m, camera = room
    counts = np.rint(depth_m / UNITS["replica"][0]).astype(np.uint16)
    with pytest.raises(InputError, match="--depth-unit replica") as refused:
        estimate_unit(counts, camera, "depth.png")
    assert "--depth-unit tum" in str(refused.value)


def test_distance_along_the_ray_is_noticed_and_undone(room: tuple[np.ndarray, CameraIntrinsics]):
    depth_m, camera = room
    depth_m = np.where(depth_m > 0, depth_m, np.nan)
    x, y = normalized_coordinates(camera)
    distance_m = depth_m * np.sqrt(1 + x**2 + y**2)
    assert not is_ray_distance(depth_m, camera)
    assert is_ray_distance(distance_m, camera)
    assert np.allclose(depth_along_axis(distance_m, camera), depth_m, equal_nan=True)


def test_real_rooms_are_in_millimetres_and_depths(real_data: Path):
    for folder in sorted((real_data / "rooms").iterdir()):
        if not folder.is_dir():
            continue
        counts = np.array(Image.open(folder / "depth.png")).astype(np.uint16)
        height, width = counts.shape
        file = folder / "camera.json"
        camera = intrinsics_for(file, read_camera_file(file), width, height)
        assert estimate_unit(counts, camera, folder.name).unit_m == 0.001
        depth_m = np.where(counts > 0, counts / 1000, np.nan)
        x, y = normalized_coordinates(camera)
        assert not is_ray_distance(depth_m, camera)
        assert is_ray_distance(depth_m * np.sqrt(1 + x**2 + y**2), camera)


def test_disparities_and_swapped_bytes(room: tuple[np.ndarray, CameraIntrinsics]):
    depth_m, _ = room
    depth_m = np.where(depth_m > 0.6, depth_m, 0.6)
    disparity = np.rint(1092.5 - 351.3 / depth_m).astype(np.uint16)  # NYU Depth V2's toolbox
    error = np.abs(depth_of_disparity(disparity) / depth_m - 1)
    assert error.max() < 0.01
    assert np.array_equal(depth_of_disparity(disparity.byteswap()), depth_of_disparity(disparity))
    refuse_swapped_bytes(disparity, "depth.png")
    with pytest.raises(InputError, match="bytes"):
        refuse_swapped_bytes(disparity.byteswap(), "depth.png")


def test_bits_of_sun_rgbd_are_rotated_back(room: tuple[np.ndarray, CameraIntrinsics]):
    depth_m, _ = room
    millimetres = np.rint(1000 * depth_m).astype(np.uint16)
    stored = (millimetres << 3) | (millimetres >> 13)
    assert is_rotated(stored)
    assert not is_rotated(millimetres)
    assert np.array_equal(rotated_by_three(stored), millimetres)


def test_a_photo_is_read_in_each_unit_and_kind(tmp_path: Path, room: tuple[np.ndarray, CameraIntrinsics]):
    """Through `read_photo`: without a camera file's unit, in each of the units the room is the same."""
    depth_m, camera = room
    photo, _ = sample_photo()
    rgb, lens = tmp_path / "rgb.png", tmp_path / "camera.json"
    Image.fromarray(photo.rgb).save(rgb)
    numbers = {name: getattr(camera, name) for name in ("fx", "fy", "cx", "cy", "width", "height")}
    lens.write_text(json.dumps(numbers))
    right = np.where(depth_m > 0, depth_m, np.nan)
    x, y = normalized_coordinates(camera)
    millimetres = np.rint(1000 * depth_m).astype(np.uint16)
    sun = ((millimetres << 3) | (millimetres >> 13)).astype(np.uint16)
    made = {
        "mm": (millimetres, {}, "mm"),
        "kitti": (np.rint(256 * depth_m), {}, "kitti"),
        "tum": (np.rint(5000 * depth_m), {"depth_unit": "tum"}, ""),
        "sun": (sun, {}, "sunrgbd"),
        "ray": (np.rint(1000 * depth_m * np.sqrt(1 + x**2 + y**2)), {}, "ray"),
    }
    for name, (counts, how, word) in made.items():
        Image.fromarray(counts.astype(np.uint16)).save(tmp_path / "depth.png")
        found, notes = read_photo(rgb, tmp_path / "depth.png", lens, **how)
        measured = np.isfinite(found.depth_m) & np.isfinite(right)
        assert np.abs(found.depth_m - right)[measured].max() < 0.003, name
        text = " ".join(notes)
        assert (word in text) if word else ("--depth-unit" not in text), name


def test_a_unit_is_a_name_or_a_number():
    assert unit_of_name("kitti") == 1 / 256
    assert unit_of_name("0.00025") == 0.00025
    with pytest.raises(InputError, match="no unit"):
        unit_of_name("furlong")


@pytest.mark.skipif(not CASES.is_dir(), reason="the made cases are not here")
@pytest.mark.parametrize(("case", "unit_m"), [("right_mm", 1e-3), ("unit_5000", 2e-4), ("unit_256", 1 / 256)])
def test_made_cases(case: str, unit_m: float):
    counts = np.array(Image.open(CASES / f"depth_{case}" / "depth.png")).astype(np.uint16)
    height, width = counts.shape
    camera = d455_intrinsics(width, height)
    assert estimate_unit(counts, camera, case).unit_m == pytest.approx(unit_m)
