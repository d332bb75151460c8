"""Fields of power become signals whose ranges, velocities and angles are those of their cells."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.hypernetwork_rooms import FieldRoom, sample_cells
from mmweaver.models.power_cells import CellSizes
from mmweaver.models.power_network import CellEchoes, PowerEncoding, PowerNetwork
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power, range_doppler_power
from tests.rooms import standing_person

BLOB = torch.tensor([2.2, 1.1, 0.25, 0.0])  # range, velocity, direction cosines
WIDE = torch.tensor([0.06, 0.2, 0.06, 0.2])


class _Blob(PowerNetwork):
    """A network whose person is a blob at a known place, and whose room is empty."""

    def person_level(self, written: torch.Tensor, body: torch.Tensor, at: torch.Tensor) -> torch.Tensor:
        return -2.0 - ((at - BLOB) / WIDE).square().sum(-1) / 2

    def room_level(self, code: PowerEncoding, at: torch.Tensor) -> torch.Tensor:
        return torch.full(at.shape[:2], -30.0)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return make_room("office", 0, 0).scene()


def _cube(network: PowerNetwork, scene: Scene, config: RadarConfig, frames: int = 2):
    torch.manual_seed(0)
    pose = standing_person((0.5, 2.1, -1.0), (0.0, 1.0, 0.0))
    motion = FrameMotion.of(replace(pose, subject=1), config, frames)
    return FieldRoom(network.eval(), scene, config).cube([motion], seed=0)


def test_the_signal_is_where_its_cells_are(scene: Scene):
    cube = _cube(_Blob(), scene, AWR1843)
    doppler = range_doppler_power(cube).mean(axis=0)
    row, column = np.unravel_index(doppler.argmax(), doppler.shape)
    grid = cube.grid
    assert grid.range_m[row] == pytest.approx(2.2, abs=0.07)
    assert grid.radial_velocity_mps[column] == pytest.approx(1.1, abs=0.28)
    angle = azimuth_axis_rad()
    beams = range_azimuth_power(cube, angle, moving_only=True).mean(axis=0)
    assert np.sin(angle[beams[row - 1 : row + 2].sum(axis=0).argmax()]) == pytest.approx(0.25, abs=0.08)


def test_a_cell_turns_from_frame_to_frame_as_from_chirp_to_chirp():
    """One scatterer that moves with its velocity: the phase advances by 4 pi v T / wavelength."""
    cell = torch.tensor([[[7, 8]]]).expand(3, 1, 2)
    speed = torch.tensor([0.0, 0.5]).expand(3, 1, 2)
    still = torch.ones(3, 1, 2)
    echoes = CellEchoes(
        range_m=2 * still, velocity_mps=speed, direction=torch.zeros(3, 1, 2, 2), cross_section_m2=still, cell=cell
    )
    time_s = torch.arange(3.0).double()[:, None] * 0.1
    amplitude = sample_cells(echoes, time_s, AWR1843, 3).amplitude
    step = (amplitude[1:] / amplitude[:-1]).angle()
    turn = 4 * np.pi * 0.5 * 0.1 / AWR1843.wavelength_m
    assert torch.allclose(step[:, 0], torch.zeros(2), atol=1e-4)
    assert torch.allclose(torch.cos(step[:, 1]), torch.full((2,), np.cos(turn)).float(), atol=1e-3)
    assert torch.allclose(amplitude, sample_cells(echoes, time_s, AWR1843, 3).amplitude)
    assert not torch.allclose(amplitude, sample_cells(echoes, time_s, AWR1843, 4).amplitude)


def test_a_field_read_finer_holds_as_much(scene: Scene):
    """Half the cell in every axis: the same cross section in all, in cells of a sixteenth."""
    pelvis = torch.tensor([2.2, 1.0, 0.2, 0.0])
    coarse = CellSizes.of(AWR1843)
    fine = replace(
        coarse, **{name: getattr(coarse, name) / 2 for name in ("range_m", "velocity_mps", "cosine_x", "cosine_z")}
    )
    sums = []
    for sizes in (coarse, fine):
        blocks, inside = sizes.boxes(pelvis, (2, 2, 2, 2))
        cells = (blocks[:, None] + inside).flatten(0, 1)
        level = _Blob().person_level(torch.zeros(1), pelvis, cells)
        sums.append(float(level.exp().sum() * sizes.moving_share))
    assert sums[1] == pytest.approx(sums[0], rel=0.05)


def test_no_more_numbers_than_the_papers():
    """A sequence of 20 frames: the room's field once, the person's for each frame."""
    from mmweaver.models.power_field import NUM_WRITTEN

    assert 21 * NUM_WRITTEN < 10_018
