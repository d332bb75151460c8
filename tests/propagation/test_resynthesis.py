"""A room and a motion that were looked at once give the simulator's samples again, without a ray caster."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL, Impairments
from mmweaver.propagation.resynthesis import Resynthesis, TracedMotion
from mmweaver.propagation.static_paths import AS_PUBLISHED
from mmweaver.propagation.static_paths_store import room_arrays, room_of, room_words
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.signal.cube import cube_values, radar_cube
from tests.rooms import standing_person

POSE = replace(standing_person((0.3, 1.9, -1.2), (0.0, 0.6, 0.0)), subject=2)
FRAMES, SEED = 4, 11
DEVICES = ["cpu", *(["cuda"] if torch.cuda.is_available() else [])]


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(make_room("office", 0, 0).scene(), AWR1843, propagation=AS_PUBLISHED)


def _replayed(simulator: Simulator, device: str, impairments: Impairments, realization: int = 0) -> np.ndarray:
    room = room_of(
        room_arrays(simulator.room), json.loads(json.dumps(room_words(simulator.room))), AWR1843, AS_PUBLISHED
    )
    joints, seen = simulator.trace(POSE, num_frames=FRAMES, seed=SEED)
    sizes = {"points": seen.skin.shape[1], "faces": seen.over_faces.shape[1], "ghosts": seen.over_faces.shape[2]}
    seen = Visibility.unpacked(seen.packed(), **sizes, static_paths=seen.occluded.shape[1])
    look = TracedMotion(joints_m=joints, visibility=seen, subject=POSE.subject, height_m=POSE.height_m, seed=SEED)
    return (
        Resynthesis(room, device, impairments).samples(look, np.arange(FRAMES), realization=realization).cpu().numpy()
    )


def error_db(got: np.ndarray, wanted: np.ndarray) -> float:
    return 10 * float(np.log10((np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum()))


@pytest.mark.parametrize("device", DEVICES)
def test_it_gives_what_the_simulator_gave(simulator: Simulator, device: str):
    """Only what moves counts here, or the room would hide every error: measured -76 dB, a relative 1.6e-4."""
    ideal = Simulator(make_room("office", 0, 0).scene(), AWR1843, IDEAL, propagation=AS_PUBLISHED)
    wanted = ideal.run(POSE, num_frames=FRAMES, seed=SEED).adc.samples
    still = ideal.room_adc
    got = _replayed(ideal, device, IDEAL)
    assert error_db(got - still, wanted - still) < -70
    assert error_db(got, wanted) < -70


@pytest.mark.parametrize("device", DEVICES)
def test_noise_and_converter_too(simulator: Simulator, device: str):
    """One count of the converter where rounding falls the other way."""
    wanted = simulator.run(POSE, num_frames=FRAMES, seed=SEED).adc.samples
    got = _replayed(simulator, device, Impairments())
    off = np.abs(got - wanted) / AWR1843.adc_count_sqrt_mw
    assert np.mean(off < 1e-3) > 0.97
    assert off.max() < 3


def test_other_phases_are_the_same_room(simulator: Simulator):
    """Nothing of the signal is as it was, and its power is."""
    first, second = (_replayed(simulator, "cpu", Impairments(), realization=number) for number in (1, 2))
    same = _replayed(simulator, "cpu", Impairments(), realization=1)
    assert np.array_equal(first, same)
    cubes = [cube_values(torch.from_numpy(samples), AWR1843).numpy() for samples in (first, second)]
    assert error_db(*cubes) > -6
    power = [float((np.abs(cube) ** 2).sum()) for cube in cubes]
    assert 10 * np.log10(power[0] / power[1]) == pytest.approx(0, abs=3)


def test_cubes_of_tensors_are_those_of_arrays():
    rng = np.random.default_rng(0)
    shape = (2, AWR1843.num_loops, AWR1843.num_tx, AWR1843.num_rx, AWR1843.num_samples, 2)
    for config in (AWR1843, replace(AWR1843, complex_samples=False)):
        samples = rng.standard_normal(shape, dtype=np.float32).view(np.complex64)[..., 0]
        samples = samples if config.complex_samples else np.real(samples).astype(np.complex64)
        wanted = radar_cube(AdcCube(samples=samples, config=config, scale=1.0)).values
        assert error_db(cube_values(torch.from_numpy(samples), config).numpy(), wanted) < -110


def test_no_ray_caster_is_needed():
    code = """
import sys
sys.modules["embreex"] = None
import numpy as np
from mmweaver.core.boards import AWR1843
from mmweaver.propagation.resynthesis import TracedMotion, Resynthesis
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.static_paths import AS_PUBLISHED, PreparedRoom
from mmweaver.propagation.occlusion import Visibility
from tests.rooms import STANDING_M

vertex = np.ones((1, 3))
paths = StaticPaths.of(np.ones(1, complex), np.full((1, 3, 4), 4.0), vertex, vertex, Interaction.DIFFUSE)
room = PreparedRoom(AWR1843, [], paths, AS_PUBLISHED)
seen = Visibility(skin=np.ones((2, 800), bool), over_faces=np.zeros((2, 0, 200), bool), occluded=np.zeros((2, 1), bool))
joints = np.array(list(STANDING_M.values()), float) + np.array([0.0, 2.0, -1.0])
joints = np.broadcast_to(joints, (2, 3, 22, 3))
look = TracedMotion(joints_m=joints, visibility=seen, subject=0, height_m=1.75, seed=0)
assert np.isfinite(Resynthesis(room).samples(look, np.arange(2)).numpy()).all()
"""
    subprocess.run([sys.executable, "-c", code], check=True)
