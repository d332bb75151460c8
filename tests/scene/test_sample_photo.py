"""The bundled room: small, reproducible from its seed, and reconstructed as it was built."""

import importlib
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from mmweaver.core.records import Scene
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct

TOOLS = Path(__file__).resolve().parents[2] / "tools"


@pytest.fixture(scope="module")
def maker() -> ModuleType:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        return importlib.import_module("make_sample_room")


@pytest.fixture(scope="module")
def scene() -> Scene:
    photo, assumptions = sample_photo()
    return reconstruct(photo, assumptions=assumptions)


def test_its_geometry_is_reconstructed(scene: Scene, maker: ModuleType):
    living_room = sys.modules["sample_room.living_room"]
    assert scene.floor_z_m == pytest.approx(-maker.CAMERA_HEIGHT_M, abs=0.01)
    pitch = np.rad2deg(np.arcsin(-scene.radar_from_camera[2, 2]))
    assert pitch == pytest.approx(maker.PITCH_DEG, abs=0.5)
    walls = [plane for plane in scene.planes if plane.kind == "wall"]
    for normal, distance in (
        ((0, -1, 0), living_room.BACK_WALL_M),
        ((1, 0, 0), -living_room.LEFT_WALL_M),
        ((-1, 0, 0), living_room.RIGHT_WALL_M),
    ):
        errors = [abs(abs(wall.normal @ wall.centre_m) - distance) for wall in walls if wall.normal @ normal > 0.999]
        assert min(errors) < 0.03


def test_its_sofa_is_found_and_its_low_table_is_not_a_seat(scene: Scene):
    assert len(scene.seats) >= 2
    for seat in scene.seats:
        assert seat.position_m[2] - scene.floor_z_m == pytest.approx(0.43, abs=0.03)
        assert -1.5 < seat.position_m[0] < 0.35
        assert np.linalg.norm(seat.position_m) < 3.2
        assert np.rad2deg(seat.facing_rad) == pytest.approx(-90, abs=16)


@pytest.mark.slow  # it renders the photo again
def test_its_depth_is_remade_from_the_seed(maker: ModuleType):
    """The whole depth is rendered again; the photo takes half a minute, so its light is rendered coarsely."""
    photo, _ = sample_photo()
    first, depth_m = maker.render(0, 1, 1, 1)
    remade = maker.measured_depth(depth_m, 0) * 0.001
    bundled = np.nan_to_num(photo.depth_m)
    assert (np.abs(remade - bundled) < 1e-6).mean() > 0.999
    difference = first.astype(float).mean(axis=(0, 1)) - photo.rgb.astype(float).mean(axis=(0, 1))
    assert np.abs(difference).max() < 6
