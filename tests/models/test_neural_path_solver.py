"""The network in a room: the same again, people added up, few numbers, right relative phases."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.compression.scatterers.layers import cell_noise
from mmweaver.core.boards import AWR1843, HUPR
from mmweaver.core.records import Scene
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom, second_order_paths
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.scene_tensors import GivenRoom
from mmweaver.propagation.adc_synthesis import phasor
from mmweaver.propagation.body_model import body_of
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.propagation.paths import Interaction, Paths
from mmweaver.propagation.ray_traced import PeoplePaths, Simulator
from mmweaver.propagation.speckle import sample_moving, sample_moving_segments
from mmweaver.propagation.static_paths import FIRST_ORDER
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.signal.cube import cube_values, radar_cube, remove_static, tdm_compensation
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


def test_people_are_added_up(scene: Scene):
    """Paths of first order of two people are those of each alone, together."""
    torch.manual_seed(0)
    first_order = GivenRoom.of(scene, AWR1843, propagation=FIRST_ORDER)
    room = LearnedRoom(WeaverNetwork().eval(), first_order, AWR1843)
    people = [_motion(-0.5), _motion(0.6, subject=1)]
    alone = sum(moving_signal(room, [one]) for one in people)
    assert np.allclose(alone, moving_signal(room, people), atol=1e-5 * np.abs(alone).max())


def moving_signal(room: LearnedRoom, motions: list[FrameMotion]) -> np.ndarray:
    return room.renderer.moving(room.paths(motions).moving).numpy()


def test_a_gliding_body_turns_the_phase_as_its_doppler_says(room: LearnedRoom):
    """Frame to frame: 4 pi v dt / wavelength, for a body that neither turns nor shadows itself anew."""
    step_s, velocity = AWR1843.frame_period_s, 0.7
    range_m = 2.0 + velocity * step_s * torch.arange(4)[:, None]
    echoes = MeanEchoes(
        range_m=range_m, velocity_mps=torch.full_like(range_m, velocity), direction=torch.zeros(4, 1, 2),
        cross_section_m2=torch.full_like(range_m, 0.1),
    )  # fmt: skip
    aspect = torch.tensor([[2.0, 0.0, 0.0]]).expand(4, -1)
    paths = sample_moving(echoes, aspect, AWR1843, 0)
    signal = paths.amplitude * phasor(paths.length_m / AWR1843.wavelength_m)
    turned = np.angle((signal[1:] / signal[:-1]).numpy())
    wanted = np.angle(np.exp(4j * np.pi * velocity * step_s / AWR1843.wavelength_m))
    assert np.allclose(np.exp(1j * turned), np.exp(1j * wanted), atol=0.02)


def test_spots_of_long_frames_add_up_to_those_of_short_ones():
    """At the middle of a segment: the same sum of phases, at the same range."""
    count = 3
    echoes = MeanEchoes(
        range_m=2.0 + 0.1 * torch.arange(4 * count).view(4, count), velocity_mps=torch.full((4, count), 0.7),
        direction=torch.zeros(4, count, 2), cross_section_m2=torch.full((4, count), 0.1),
    )  # fmt: skip
    turning_rad = torch.linspace(0, 0.3, 4)
    aspect = 2 * torch.stack([turning_rad.cos(), turning_rad.sin(), torch.zeros(4)], dim=-1)
    one = sample_moving(echoes, aspect, HUPR, 0)
    segments = echoes.map(lambda tensor: tensor[None])
    spots = sample_moving_segments(segments, aspect[None], 0.01 * torch.arange(4), HUPR, 0)
    assert torch.allclose(spots.amplitude.unflatten(1, (count, -1)).sum(dim=-1), one.amplitude, rtol=1e-4)
    assert torch.allclose(spots.length_m.unflatten(1, (count, -1)), one.length_m[..., None])
    turning = (spots.rate_mps - 2 * 0.7).abs()
    assert 0.05 < float(turning.mean()) < 10  # 10 rad/s


def test_an_empty_floor_has_no_more_than_its_own_echoes():
    """A room of two faces: fewer echoes than places for them, and nothing that is no number."""
    torch.manual_seed(0)
    room = LearnedRoom(
        WeaverNetwork().eval(), replace(scene_of((floor(), back_wall())), photo=make_room("gym", 0, 0).photo()), AWR1843
    )
    assert np.isfinite(room.cube([_motion(0.0)], seed=0).values).all()


def test_samples_give_the_cube_again_and_the_cube_does_not_depend_on_them(room: LearnedRoom):
    motion = _motion(0.3, -0.5)
    cube, adc = room.signal([motion], seed=5, keep_adc=True)
    assert np.array_equal(cube.values, room.cube([motion], seed=5).values)
    assert adc is not None
    again = radar_cube(adc)
    assert _error_db(again.values, cube.values) < -38
    assert _error_db(remove_static(again).values, remove_static(cube).values) < -33


def test_noise_of_samples_is_white_and_has_the_cells_that_were_asked_for(room: LearnedRoom):
    cells = cell_noise(np.random.default_rng(0), AWR1843, 3) * np.float32(np.sqrt(room.noise_power))
    cells *= tdm_compensation(AWR1843)
    samples = room._sample_noise(cells, 0, 1)
    assert _error_db(cube_values(samples, AWR1843), cells) < -90
    power = np.abs(samples) ** 2
    assert power.mean() == pytest.approx(AWR1843.noise_power_mw, rel=0.01)
    assert power.mean(axis=(0, 1, 2, 3)) == pytest.approx(np.full(256, AWR1843.noise_power_mw), rel=0.15)
    assert power.mean(axis=(0, 2, 3, 4)) == pytest.approx(np.full(32, AWR1843.noise_power_mw), rel=0.1)


def test_who_stands_behind_another_is_occluded(room: LearnedRoom, scene: Scene):
    front, behind = (_standing(0.0, y_m, subject) for subject, y_m in enumerate((1.4, 2.6)))
    aside = _standing(0.9, 2.6, 1)
    given = GivenRoom.of(scene, AWR1843, propagation=FIRST_ORDER)
    room = LearnedRoom(room.network, given, AWR1843)
    both, away = (room.paths([front, other]).moving for other in (behind, aside))
    alone = room.paths([behind]).moving
    count = alone.amplitude.shape[1]

    def power(paths):
        return float(paths.amplitude[:, -count:].abs().square().sum())

    assert power(both) < 0.2 * power(alone)
    assert power(away) == pytest.approx(power(room.paths([aside]).moving), rel=1e-5)


def test_paths_of_second_order_are_those_of_physics_on_average(scene: Scene):
    """Within 3 dB of the ray tracer's, which has more points of skin and pairs, and bodies that occlude themselves."""
    torch.manual_seed(0)
    room = LearnedRoom(WeaverNetwork().eval(), scene, AWR1843)
    simulator = Simulator(scene, AWR1843)
    ratios_db = []
    for x_m, y_m in ((-0.4, 1.6), (0.2, 2.0), (0.5, 2.6)):
        powers = np.zeros(2)
        for subject in range(6):  # one person's skin is 3 dB brighter than another's
            pose = replace(standing_person((x_m, y_m, -1.2)), subject=subject)
            motion = FrameMotion.of(pose, AWR1843, 1)
            joints_m = simulator._joints_at_nodes(pose, np.arange(1))
            people = PeoplePaths(simulator.room, [body_of(pose)], simulator.clock, [joints_m])
            own = second_order_paths(room.given.traced, [motion], room.renderer.clock)
            powers += [_power_over_room(own), _power_over_room(people.scene(1).moving)]
        ratios_db.append(10 * np.log10(powers[0] / powers[1]))
    assert np.abs(ratios_db).max() < 3


def _power_over_room(paths: Paths) -> float:
    return float((paths.amplitude * (paths.interaction == int(Interaction.BODY_ROOM))).abs().square().sum())


def test_long_frames_are_rendered_by_segments(scene: Scene):
    """Samples and cube of the same paths agree; a waver's Doppler spreads as far as the motion does within a frame."""
    torch.manual_seed(0)
    room = LearnedRoom(WeaverNetwork().eval(), scene, HUPR)
    pose = standing_person((0.0, 2.2, -1.2), (0.0, -0.5, 0.0))
    motion = FrameMotion.of(pose, HUPR, 2)
    assert (motion.num_segments, motion.joints_m.shape) == (7, (14, 22, 3))
    cube, adc = room.signal([motion], seed=0, keep_adc=True)
    assert adc is not None
    assert _error_db(radar_cube(adc).values, cube.values) < -36
    at_middle = FrameMotion(
        joints_m=motion.joints_m[3::7], velocity_mps=motion.velocity_mps[3::7], subject=motion.subject
    )
    steady = room.cube([at_middle], seed=0)
    # a stiff body that glides is the same, extrapolated from the middle of each frame
    assert _error_db(remove_static(steady).values, remove_static(cube).values) < -15


def _standing(x_m: float, y_m: float, subject: int) -> FrameMotion:
    return FrameMotion.of(replace(standing_person((x_m, y_m, -1.2)), subject=subject), AWR1843, 3)


def _error_db(got: np.ndarray, wanted: np.ndarray) -> float:
    return 10 * float(np.log10((np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum()))
