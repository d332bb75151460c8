"""A recording of the empty room: it comes out again, bodies hide what is theirs, counts become milliwatts."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.core.records import RadarCube, Scene
from mmweaver.dsp.cube import radar_cube
from mmweaver.models.learned_paths import FrameMotion, LearnedRoom
from mmweaver.models.network import WeaverNetwork
from mmweaver.paths.background import BackgroundRecording, agreeing_gain
from mmweaver.paths.random_phases import SampledStaticClutter
from mmweaver.paths.ray_traced import Simulator
from mmweaver.scene.procedural.procedural_room import make_room
from tests.rooms import standing_person

REST = AWR1843.num_loops // 2


@pytest.fixture(scope="module")
def scene() -> Scene:
    return make_room("office", 0, 0).scene()


@pytest.fixture(scope="module")
def recording(scene: Scene) -> RadarCube:
    return radar_cube(Simulator(scene, AWR1843, micro_seed=7).run((), num_frames=8, seed=1).adc)


def _woven(scene: Scene, recording: RadarCube | None) -> LearnedRoom:
    torch.manual_seed(0)
    return LearnedRoom(WeaverNetwork().eval(), scene, AWR1843, background=recording)


def _still(cube: RadarCube) -> np.ndarray:
    return cube.values[:, :, REST].mean(axis=0)


def test_what_rests_is_the_recordings_own(scene: Scene, recording: RadarCube):
    known, drawn = (_woven(scene, one) for one in (recording, None))
    turn = known.radar.response.turn(known.radar.axes)[:, REST]
    recorded = _still(recording)
    assert np.allclose((known.static * turn).numpy(), recorded, atol=1e-6 * np.abs(recorded).max())
    assert np.linalg.norm((drawn.static * turn).numpy() - recorded) > np.linalg.norm(recorded)


def test_counts_without_a_scale_come_out_as_counts(scene: Scene, recording: RadarCube):
    counts = replace(recording, values=(1e6 * recording.values).astype(np.complex64), scale=float("nan"))
    with_scale, without = (_woven(scene, one) for one in (recording, counts))
    assert with_scale.empty is not None
    assert without.empty is not None
    assert with_scale.empty.assumptions == ()
    assert "no absolute scale" in without.empty.assumptions[0]
    assert without.empty.unit == pytest.approx(1e-6, rel=0.5)  # by what the network expects
    motion = FrameMotion.of(standing_person((0.0, 2.2, -1.2)), AWR1843, 4)
    cube = without.cube([motion], seed=0)
    assert cube.scale == without.empty.unit
    assert np.linalg.norm(_still(cube)) == pytest.approx(np.linalg.norm(_still(counts)), rel=0.3)
    # and its noise is the recording's
    moving = [bin_ for bin_ in range(AWR1843.num_loops) if abs(bin_ - REST) > 8]
    levels = [np.median(np.abs(one.values[:, :, moving])) for one in (cube, counts)]
    assert levels[0] == pytest.approx(levels[1], rel=0.05)


def test_a_shadow_takes_away_what_was_recorded_and_not_what_was_drawn():
    """Where the geometry explains the recording, with fewer echoes than cells and with more."""
    at_range = torch.zeros(2, 64, dtype=torch.complex64)
    at_range[0, 20] = at_range[1, 40] = 1.0
    drawn = SampledStaticClutter(
        heard=torch.arange(2), num_strong=2, at_range=at_range, echo=torch.ones(2, 12, dtype=torch.complex64)
    )
    still = torch.zeros(64, 12, dtype=torch.complex64)
    still[20], still[40], still[50] = 3j, -0.5, 2.0  # at 50 the geometry knows of nothing
    empty = BackgroundRecording(still=still, noise_power=1e-9, unit=1.0, assumptions=())
    known = empty.conditioned(drawn)
    assert torch.equal(known.layer(), still)
    hidden = known.hidden(torch.tensor([[True, True]]))[0]
    assert torch.allclose(hidden[20], still[20], rtol=0.05)
    assert torch.allclose(hidden[40], still[40], rtol=0.05)
    assert float(hidden[50].abs().max()) < 1e-3
    many = SampledStaticClutter(heard=torch.arange(900), num_strong=900, at_range=at_range[[0]].repeat(900, 1),
                      echo=drawn.echo[[0]].repeat(900, 1))  # fmt: skip
    shared = empty.conditioned(many).hidden(torch.ones(1, 900, dtype=torch.bool))[0]
    assert torch.allclose(shared[20], still[20], rtol=0.05)


def test_what_moves_in_the_recording_is_told(scene: Scene, recording: RadarCube):
    values = recording.values.copy()
    values[:, 30, 5] += 100 * np.abs(values[:, :, 5]).mean()
    woven = _woven(scene, replace(recording, values=values))
    assert woven.empty is not None
    assert any("moves" in sentence for sentence in woven.empty.assumptions)


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
        _woven(scene, harmed)


def test_a_recording_of_some_other_place_has_no_scale():
    """Leakage at one range outshines all, and the photo knows of nothing there."""
    expected, own = torch.tensor([[1.0, 1e-9]]), torch.tensor([[1e-9, 1.0]])
    with pytest.raises(InputError, match="no echo where the photo has a surface"):
        agreeing_gain([(expected, own)])


def test_the_gain_is_the_middle_of_what_both_show():
    expected = torch.tensor([[4.0, 4.0, 400.0, 1e-9]])
    own = torch.ones(1, 4)
    assert agreeing_gain([(expected, own)]) == pytest.approx(2.0)
