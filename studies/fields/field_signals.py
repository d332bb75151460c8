"""The radar sequences of the field and codec studies: simulated people in the sample room, and real recordings."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843, BGT60, halfwave_positions
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence, RadarCube, Scene
from mmweaver.core.registry import Registry
from mmweaver.core.seeding import stream
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.propagation.diffuse_clutter import seed_of_room
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL, Impairments
from mmweaver.propagation.static_paths import Propagation
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from mmweaver.signal.windows import hann

NUM_FRAMES = 20
SENTENCES = {
    "walking": "a person walks towards the radar",
    "waving": "a person stands and waves with the left hand",
    "sitting": "a person sits down on a chair",
}
ALONE = "_alone"
NOISE_FREE = replace(IDEAL, leakage_db=Impairments().leakage_db)
OTHER_SKIN = 1_000  # added to the subject: the same pose, other skin points and micro-phases


@dataclass(frozen=True, kw_only=True)
class StudySignal:
    """A cube to study, and where they can be simulated two oracles: another realization (same pose and room, other
    micro-phases of the skin) and the same cube without noise, the best that a field without noise can be."""

    name: str
    origin: str  # simulated | recorded | recorded, with a simulated person
    cube: RadarCube
    realization: RadarCube | None
    noise_free: RadarCube | None = None

    @property
    def digest(self) -> str:
        """The first 16 digits of the SHA-256 of the cube's values."""
        return hashlib.sha256(np.ascontiguousarray(self.cube.values).tobytes()).hexdigest()[:16]


@lru_cache(maxsize=1)
def sample_scene() -> Scene:
    """The room that comes with the project."""
    photo, assumptions = sample_photo()
    return reconstruct(photo, assumptions=assumptions)


def without_room(scene: Scene) -> Scene:
    """The same scene without any reflecting surface."""
    return replace(
        scene,
        vertices_m=np.zeros((0, 3), np.float32),
        faces=np.zeros((0, 3), np.int32),
        face_material=np.zeros(0, np.int32),
        planes=(),
    )


def simulator_of(
    scene: Scene, radar: RadarConfig, receiver: Impairments | None = None, board: Board | None = None
) -> Simulator:
    """All paths, and the clutter of the room where there is one; an ideal board unless one is given."""
    paths = Propagation(clutter=len(scene.faces) > 0)
    return Simulator(scene, radar, receiver, micro_seed=seed_of_room(scene), board=board, propagation=paths)


def pose_of(activity: str, *, seconds: float, seed: int = 0, radar: RadarConfig = AWR1843) -> PoseSequence:
    """A person in the sample room, within the range window of the radar, performing the sentence of an activity."""
    window_m = (float(radar.range_m[0]), float(radar.range_m[-1]))
    plan = plan_motion(SENTENCES[activity], seconds)
    return compose(plan, sample_scene(), seed=seed, range_window_m=window_m).pose


def simulated(
    activity: str,
    *,
    is_alone: bool,
    num_frames: int = NUM_FRAMES,
    impairments: Impairments | None = None,
    seed: int = 0,
) -> StudySignal:
    """A person simulated in the sample room, or without a room, with the awr1843."""
    pose = pose_of(activity, seconds=num_frames * AWR1843.frame_period_s, seed=seed)
    impairments = impairments or Impairments()
    scene = sample_scene()
    if is_alone:
        scene, impairments = without_room(scene), replace(impairments, leakage_db=None)
    quiet = replace(NOISE_FREE, leakage_db=impairments.leakage_db)
    other = replace(pose, subject=pose.subject + OTHER_SKIN)
    cube, realization, noise_free = (
        radar_cube(simulator_of(scene, AWR1843, receiver).run(skin, num_frames=num_frames, seed=seed).adc)
        for skin, receiver in ((pose, impairments), (other, impairments), (pose, quiet))
    )
    name = activity + (ALONE if is_alone else "")
    return StudySignal(name=name, origin="simulated", cube=cube, realization=realization, noise_free=noise_free)


def two_people_radar(num_loops: int = 32) -> RadarConfig:
    """The radar of the recorded two people; idle and ramp-end times are not stated and assumed.

    2 TX x 4 RX in one row, virtual antennas from right to left; range bins 32 to 95.
    """
    middle_hz = 77e9 + 60e12 * (6e-6 + 128 / 2.5e6 / 2)
    return RadarConfig(
        name="two_people", start_frequency_hz=77e9, chirp_slope_hz_per_s=60e12, idle_time_s=7e-6,
        adc_start_time_s=6e-6, ramp_end_time_s=60e-6, num_samples=128, sample_rate_hz=2.5e6, num_loops=num_loops,
        frame_period_s=0.1, tx_position_m=halfwave_positions(((0.0, 0.0), (-4.0, 0.0)), middle_hz),
        rx_position_m=halfwave_positions(((0.0, 0.0), (-1.0, 0.0), (-2.0, 0.0), (-3.0, 0.0)), middle_hz),
        tx_order=(0, 1), first_range_bin=32, num_range_bins=64,
    )  # fmt: skip


def two_people(data: Path) -> StudySignal:
    """20 windows of 32 loops, 5 loops apart, of one long frame of two moving people.

    Windows overlap, which favours whatever exploits similarity between frames.
    """
    hop, length = 5, 32
    whole = _two_people_frame(data).samples[0]
    config = two_people_radar(length)
    windows = np.stack([whole[hop * at : hop * at + length] for at in range(NUM_FRAMES)])
    cube = radar_cube(AdcCube(samples=windows, config=config, scale=float("nan")))
    times_s = np.arange(NUM_FRAMES) * hop * config.loop_period_s
    cube = replace(cube, grid=replace(cube.grid, frame_time_s=times_s))
    return StudySignal(name="two_people", origin="recorded", cube=cube, realization=None)


def _two_people_frame(data: Path) -> AdcCube:
    """The recording unchanged: one frame of 128 loops."""
    path = data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy"
    return read_adc_npy(path, two_people_radar(num_loops=128), "loop,vrx,sample")


def walking_in_recording(data: Path, seed: int = 0) -> StudySignal:
    """Recorded static clutter of the radar of the two people, with a simulated walker added.

    Clutter: mean of the recording over its 128 loops, including gains and phases of the real array. Walker: as strong
    as the recorded people (strongest moving cell), ideal array. Noise: white, as strong as that of the recording
    (median of the cells in the outer half of the velocities). 20 frames, 0.1 s apart.
    """
    frame, config = _two_people_frame(data), two_people_radar()
    pose = pose_of("walking", seconds=NUM_FRAMES * config.frame_period_s, seed=seed, radar=config)
    simulator = simulator_of(without_room(sample_scene()), config, IDEAL)
    skins = (pose, replace(pose, subject=pose.subject + OTHER_SKIN))
    walkers = [simulator.run(skin, num_frames=NUM_FRAMES, seed=seed).adc for skin in skins]
    gain = np.sqrt(_strongest_moving(two_people(data).cube) / _strongest_moving(radar_cube(walkers[0])))
    shape = (*walkers[0].samples.shape, 2)
    noise = stream(seed, "walking_in_recording noise").standard_normal(shape, dtype=np.float32).view(np.complex64)
    hiss = noise[..., 0] * np.sqrt(_sample_noise_power(frame) / 2)
    still = frame.samples.mean(axis=1, keepdims=True)
    cube, realization, noise_free = (
        radar_cube(AdcCube(samples=samples.astype(np.complex64), config=config, scale=float("nan")))
        for samples in (
            still + gain * walkers[0].samples + hiss,
            still + gain * walkers[1].samples + hiss,
            still + gain * walkers[0].samples,
        )
    )
    return StudySignal(
        name="walking_in_recording", origin="recorded, with a simulated person", cube=cube, realization=realization,
        noise_free=noise_free,
    )  # fmt: skip


def _strongest_moving(cube: RadarCube) -> float:
    return float(range_doppler_power(cube)[:, :, moving_doppler(cube)].max())


def _sample_noise_power(adc: AdcCube) -> float:
    """Noise power per ADC sample, from cells in the outer half of the velocities (chi-squared: median ln 2)."""
    cube, config = radar_cube(adc), adc.config
    is_fast = np.abs(config.radial_velocity_mps) > config.max_velocity_mps / 2
    cell = float(np.median(np.abs(cube.values[:, :, is_fast]) ** 2)) / np.log(2)
    windows = (hann(config.num_samples), hann(config.num_loops))
    return cell / float(np.prod([np.sum(window**2) / np.sum(window) ** 2 for window in windows]))


def breathing(data: Path) -> StudySignal:
    """Every third of the first 60 frames of a person who breathes before a BGT60: 20 frames, 4.6 s."""
    path = data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    adc = read_adc_npy(path, BGT60, "frame,rx,loop,sample")
    config = replace(BGT60, frame_period_s=3 * BGT60.frame_period_s)
    cube = radar_cube(AdcCube(samples=adc.samples[: 3 * NUM_FRAMES : 3], config=config, scale=float("nan")))
    return StudySignal(name="breathing", origin="recorded", cube=cube, realization=None)


def _recorded(read: Callable[[Path], StudySignal]) -> Callable[[Path | None], StudySignal]:
    def make(data: Path | None) -> StudySignal:
        if data is None:
            raise InputError("this signal is a recording; say where the recordings lie with --data")
        return read(data)

    return make


def _simulated(activity: str, is_alone: bool) -> Callable[[Path | None], StudySignal]:
    return lambda data: simulated(activity, is_alone=is_alone)


SIGNALS: Registry[Callable[[Path | None], StudySignal]] = Registry(
    "signal",
    [
        ("walking_alone", _simulated("walking", True)),
        ("walking", _simulated("walking", False)),
        ("waving", _simulated("waving", False)),
        ("sitting", _simulated("sitting", False)),
        ("two_people", _recorded(two_people)),
        ("walking_in_recording", _recorded(walking_in_recording)),
        ("breathing", _recorded(breathing)),
    ],
)
RECORDED = ("two_people", "walking_in_recording", "breathing")  # all that need recordings
