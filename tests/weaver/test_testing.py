"""The checks for extensions pass what works and name what does not."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch
from torch import nn

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.models.methods import Physics, Signal
from mmweaver.weaver import testing
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room

SMALL = replace(AWR1843, name="small", num_loops=8, num_range_bins=56)


@pytest.fixture(scope="module")
def room() -> Room:
    return Weaver("physics").sample_room()


def method_of(values: Any):
    """A method whose cube is values(shape, seed, keep_adc)."""

    def method(scene, poses, config, *, num_frames, seed, keep_adc, stages, **more) -> Signal:
        grid = CubeGrid.of(config, num_frames)
        cube = RadarCube(values=values(grid.shape, seed, keep_adc), grid=grid, config=config, scale=1.0)
        return Signal(cube=cube, adc=None, assumptions=())

    return method


def test_physics_is_a_method(room: Room):
    testing.check_method(Physics(), room=room, radar=SMALL)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        (lambda shape, seed, adc: np.random.default_rng().normal(size=shape).astype(np.complex64), "the same bits"),
        (lambda shape, seed, adc: np.full(shape, np.nan, np.complex64), "finite"),
        (lambda shape, seed, adc: np.ones(shape, np.complex128), "must be complex64"),
        (lambda shape, seed, adc: np.ones((2, *shape[1:]), np.complex64), "cube must be"),
    ],
)
def test_a_bad_method_is_named(values: Any, says: str, room: Room):
    with pytest.raises(Exception, match=says):
        testing.check_method(method_of(values), room=room, radar=SMALL)


def test_radars():
    testing.check_radar(SMALL)
    with pytest.raises(AssertionError, match="'far'"):
        testing.check_radar(replace(SMALL, name="far", first_range_bin=190))


def test_encoders():
    class Encoder(nn.Module):
        def __init__(self, size: int = 512) -> None:
            super().__init__()
            self.places = nn.Conv2d(5, 40, 9, stride=8, padding=4)
            self.project = nn.Linear(40, size)

        def forward(self, image: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
            places = self.places(image)
            return self.project(places.mean(dim=(2, 3))), places

    testing.check_encoder(Encoder)
    with pytest.raises(AssertionError, match=r"z_env.*512.*256"):
        testing.check_encoder(lambda: Encoder(256))
