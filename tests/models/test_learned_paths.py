"""The network in a room: the same again, people added up, few numbers, right relative phases."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.presets import AWR1843
from mmweaver.core.records import Scene
from mmweaver.models.learned_paths import FrameMotion, LearnedRoom
from mmweaver.models.network import WeaverNetwork
from mmweaver.paths.mean_paths import Echoes
from mmweaver.scene.procedural.procedural_room import make_room
from tests.rooms import back_wall, floor, scene_of, standing_person


@pytest.fixture(scope="module")
def scene() -> Scene:
    return make_room("office", 0, 0).scene()


@pytest.fixture(scope="module")
def room(scene: Scene) -> LearnedRoom:
    torch.manual_seed(0)
    return LearnedRoom(WeaverNetwork().eval(), scene, AWR1843)


def _motion(x_m: float, velocity_mps: float = 0.0, subject: int = 0) -> FrameMotion:
    pose = standing_person((x_m, 2.2, -1.2), (0.0, velocity_mps, 0.0))
    return FrameMotion.of(replace(pose, subject=subject), AWR1843, 6)


def test_the_same_asked_twice_is_the_same(room: LearnedRoom):
    motion = _motion(0.3, -0.5)
    assert np.array_equal(room.cube([motion], seed=3).values, room.cube([motion], seed=3).values)
    other = room.cube([motion], seed=4).values
    assert not np.array_equal(room.cube([motion], seed=3).values, other)


def test_people_are_added_up(room: LearnedRoom):
    """What two fields have more than that of both is the room, whoever they are."""
    people = [_motion(-0.5), _motion(0.6, subject=1), _motion(0.0, -0.4, subject=2)]
    alone = [room.field([one]).native() for one in people]
    first = alone[0] + alone[1] - room.field(people[:2]).native()
    second = alone[1] + alone[2] - room.field(people[1:]).native()
    assert np.allclose(first, second, atol=1e-5 * np.abs(alone[0]).max())


def test_twenty_frames_are_at_most_10018_numbers(room: LearnedRoom):
    pose = standing_person((0.0, 2.2, -1.2), seconds=2.1)
    field = room.field([FrameMotion.of(pose, AWR1843, 20)])
    assert field.num_values <= 10_018


def test_a_gliding_body_turns_the_phase_as_its_doppler_says(room: LearnedRoom):
    """Frame to frame: 4 pi v dt / wavelength, for a body that neither turns nor shadows itself anew."""
    from mmweaver.paths.random_phases import sample_moving

    step_s, velocity = AWR1843.frame_period_s, 0.7
    range_m = 2.0 + velocity * step_s * torch.arange(4)[:, None]
    echoes = Echoes(
        range_m=range_m, velocity_mps=torch.full_like(range_m, velocity), direction=torch.zeros(4, 1, 2),
        cross_section_m2=torch.full_like(range_m, 0.1),
    )  # fmt: skip
    aspect = torch.tensor([[2.0, 0.0, 0.0]]).expand(4, -1)
    points = sample_moving(echoes, aspect, room.radar.response, 0)
    turned = np.angle((points.amplitude[1:] / points.amplitude[:-1]).numpy())
    wanted = np.angle(np.exp(4j * np.pi * velocity * step_s / AWR1843.wavelength_m))
    assert np.allclose(np.exp(1j * turned), np.exp(1j * wanted), atol=0.02)


def test_an_empty_floor_has_no_more_than_its_own_echoes():
    """A room of two faces: fewer echoes than places for them, and nothing that is no number."""
    torch.manual_seed(0)
    room = LearnedRoom(
        WeaverNetwork().eval(), replace(scene_of((floor(), back_wall())), photo=make_room("gym", 0, 0).photo()), AWR1843
    )
    assert np.isfinite(room.field([_motion(0.0)]).native()).all()
