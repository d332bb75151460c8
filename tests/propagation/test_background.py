"""A recording of the empty room: it comes out again, bodies hide what is theirs, counts become milliwatts."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube, Scene
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import BackgroundRecording, agreeing_gain
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.signal.cube import radar_cube
from tests.rooms import standing_person

REST = AWR1843.num_loops // 2


@pytest.fixture(scope="module")
def scene() -> Scene:
    return make_room("office", 0, 0).scene()


@pytest.fixture(scope="module")
def recording(scene: Scene) -> RadarCube:
    return radar_cube(Simulator(scene, AWR1843, micro_seed=7).run((), num_frames=8, seed=1).adc)


def _learned_room(scene: Scene, recording: RadarCube | None) -> LearnedRoom:
    torch.manual_seed(0)
    return LearnedRoom(WeaverNetwork().eval(), scene, AWR1843, background=recording)


def _still(cube: RadarCube) -> np.ndarray:
    return cube.values[:, :, REST].mean(axis=0)


def test_static_clutter_is_the_recordings_own(scene: Scene, recording: RadarCube):
    known, sampled = (_learned_room(scene, one) for one in (recording, None))
    recorded = _still(recording)
    assert np.allclose(known.layer.numpy(), recorded, atol=1e-6 * np.abs(recorded).max())
    assert np.linalg.norm(sampled.layer.numpy() - recorded) > np.linalg.norm(recorded)


def test_counts_without_a_scale_come_out_as_counts(scene: Scene, recording: RadarCube):
    counts = replace(recording, values=(1e6 * recording.values).astype(np.complex64), scale=float("nan"))
    with_scale, without = (_learned_room(scene, one) for one in (recording, counts))
    assert with_scale.background is not None
    assert without.background is not None
    assert with_scale.background.assumptions == ()
    assert "no absolute scale" in without.background.assumptions[0]
    assert without.background.unit == pytest.approx(1e-6, rel=0.5)  # by what the network expects
    motion = FrameMotion.of(standing_person((0.0, 2.2, -1.2)), AWR1843, 4)
    cube = without.cube([motion], seed=0)
    assert cube.scale == without.background.unit
    assert np.linalg.norm(_still(cube)) == pytest.approx(np.linalg.norm(_still(counts)), rel=0.3)
    # and its noise is the recording's
    moving = [bin_ for bin_ in range(AWR1843.num_loops) if abs(bin_ - REST) > 8]
    levels = [np.median(np.abs(one.values[:, :, moving])) for one in (cube, counts)]
    assert levels[0] == pytest.approx(levels[1], rel=0.05)


def test_occlusion_takes_away_what_was_recorded_and_not_what_was_sampled():
    """Where the geometry explains the recording, with fewer paths than cells and with more."""
    place_m = np.array([[0.0, 20 * AWR1843.range_resolution_m, 0.0], [0.0, 40 * AWR1843.range_resolution_m, 0.0]])
    place_m += [0.0, AWR1843.first_range_bin * AWR1843.range_resolution_m, 0.0]
    sampled = scattered_paths(place_m, np.ones(2), Interaction.DIFFUSE, AWR1843)
    renderer = CubeRenderer(AWR1843)
    static = renderer.static(sampled).scaled(torch.tensor([3j, -0.5])).layer()
    static[50] += 2.0  # the geometry knows of nothing there
    background = BackgroundRecording(
        static=static, noise_power=1e-9, sample_noise_mw=1e-9, unit=1.0, count_sqrt_mw=1e-6, assumptions=()
    )
    known = renderer.static(background.conditioned(sampled, renderer)).layer()
    assert torch.allclose(known[20], static[20], rtol=0.05)
    assert torch.allclose(known[40], static[40], rtol=0.05)
    assert float(known[50].abs().max()) < 0.05
    many = StaticPaths.cat([sampled[:1]] * 900)
    shared = renderer.static(background.conditioned(many, renderer)).layer()
    assert torch.allclose(shared[20], static[20], rtol=0.05)


def test_what_moves_in_the_recording_is_told(scene: Scene, recording: RadarCube):
    values = recording.values.copy()
    values[:, 30, 5] += 100 * np.abs(values[:, :, 5]).mean()
    room = _learned_room(scene, replace(recording, values=values))
    assert room.background is not None
    assert any("moves" in sentence for sentence in room.background.assumptions)


@pytest.mark.parametrize("harm", ["radar", "slower", "nan", "zeros", "none"])
def test_what_is_no_recording_of_this_radar_is_refused(scene: Scene, recording: RadarCube, harm: str):
    values = recording.values
    harmed = {
        "radar": replace(recording, config=replace(AWR1843, chirp_slope_hz_per_s=0.9 * AWR1843.chirp_slope_hz_per_s)),
        "slower": replace(recording, config=replace(AWR1843, num_loops=512, frame_period_s=0.5)),
        "nan": replace(recording, values=values * np.float32("nan")),
        "zeros": replace(recording, values=np.zeros_like(values)),
        "none": replace(recording, values=values[:0]),
    }[harm]
    with pytest.raises(InputError, match="other settings" if harm in ("radar", "slower") else "no signal"):
        _learned_room(scene, harmed)


def test_a_recording_of_some_other_place_has_no_scale():
    """Leakage at one range outshines all, and the photo knows of nothing there."""
    expected, own = torch.tensor([[1.0, 1e-9]]), torch.tensor([[1e-9, 1.0]])
    with pytest.raises(InputError, match="no echo"):
        agreeing_gain([(expected, own)])


def test_the_gain_is_the_middle_of_what_both_show():
    expected = torch.tensor([[4.0, 4.0, 400.0, 1e-9]])
    own = torch.ones(1, 4)
    assert agreeing_gain([(expected, own)]) == pytest.approx(2.0)
