"""One room of a data set: its photo, and the radar signal of everything that happens in it."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, RgbdPhoto, Scene
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M, RoomSpec, SequenceSpec
from mmweaver.dsp.cube import radar_cube
from mmweaver.motion.animation.resample import joints_and_velocities
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.static_paths import PreparedRoom, RayTracedRoom
from mmweaver.paths.visibility import Visibility
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct

RETRIES = 5  # other places for a motion that a room has no place for


@dataclass(frozen=True, kw_only=True)
class MadeSequence:
    """A sequence: cube in sqrt(mW), and joints at the middle of each radar frame."""

    spec: SequenceSpec
    cube: RadarCube
    joints_m: np.ndarray  # (frame, 22, 3) float32
    joint_velocity_mps: np.ndarray  # (frame, 22, 3) float32


@dataclass(frozen=True, kw_only=True)
class TracedSequence:
    """A sequence whose signal is not made yet: joints as in `MadeSequence`, and what `paths.resynthesis` needs."""

    spec: SequenceSpec
    joints_m: np.ndarray
    joint_velocity_mps: np.ndarray
    node_joints_m: np.ndarray  # (frame, node, 22, 3) float32
    visibility: Visibility


@dataclass(frozen=True, kw_only=True)
class RoomGeometry:
    """A room after its rays were cast: as it is, and as its photo shows it."""

    room: PreparedRoom
    photographed: PreparedRoom


@dataclass(frozen=True, kw_only=True)
class MadeRoom:
    """A room with its sequences; `refused` says which specs had no place in it, and why.

    With `geometry` the sequences are looked at, without it they have their cubes.
    """

    spec: RoomSpec
    photo: RgbdPhoto
    empty: np.ndarray  # complex64 (range, antenna), what stands still without a person, at zero Doppler's peak
    sequences: tuple[MadeSequence, ...] | tuple[TracedSequence, ...]
    refused: tuple[tuple[int, str], ...]
    geometry: RoomGeometry | None = None


def make(spec: RoomSpec, config: RadarConfig, num_frames: int, *, geometry_only: bool = False) -> MadeRoom:
    """Makes a room and all its sequences by the simulator. Slow: about 0.3 s of CPU for each sequence.

    With `geometry_only` signals are left to be made from what is kept, for a third of it.
    """
    room = make_room(spec.kind, spec.layout, spec.seed)
    truth = room.scene(spec.lighting)
    simulator = Simulator(truth, config)
    photo = room.photo(spec.lighting, noise=True)
    one = trace_sequence if geometry_only else make_sequence
    made, refused = [], []
    for sequence in spec.sequences:
        try:
            made.append(one(sequence, truth, simulator, num_frames))
        except InputError as error:
            refused.append((sequence.index, str(error)))
    return MadeRoom(
        spec=spec, photo=photo, empty=_empty(simulator), sequences=tuple(made), refused=tuple(refused),
        geometry=_geometry(simulator, photo) if geometry_only else None,
    )  # fmt: skip


def _geometry(simulator: Simulator, photo: RgbdPhoto) -> RoomGeometry:
    stored = replace(photo, depth_m=photo.depth_m.astype(np.float32).astype(np.float64))  # as it will be read
    return RoomGeometry(room=simulator.room, photographed=RayTracedRoom(reconstruct(stored), simulator.config))


def trace_sequence(spec: SequenceSpec, scene: Scene, simulator: Simulator, num_frames: int) -> TracedSequence:
    """One sequence without its signal. Raises InputError where there is no room."""
    pose = pose_of(spec, scene, simulator.config, num_frames)
    nodes_m, visibility = simulator.look(pose, num_frames=num_frames, seed=spec.seed)
    joints, velocity = _at_frames(pose, CubeGrid.of(simulator.config, num_frames), simulator.config)
    return TracedSequence(
        spec=spec, joints_m=joints, joint_velocity_mps=velocity, node_joints_m=nodes_m, visibility=visibility
    )


def make_sequence(
    spec: SequenceSpec,
    scene: Scene,
    simulator: Simulator,
    num_frames: int,
    *,
    subject: int | None = None,
    noise_seed: int | None = None,
) -> MadeSequence:
    """One sequence; another `subject` has another skin and another `noise_seed` other noise (a twin).

    Raises InputError where there is no room.
    """
    config = simulator.config
    pose = pose_of(spec, scene, config, num_frames)
    if subject is not None:
        pose = replace(pose, subject=subject)
    seed = spec.seed if noise_seed is None else noise_seed
    parts = [radar_cube(chunk).values for chunk in simulator.chunks(pose, num_frames=num_frames, seed=seed)]
    grid = CubeGrid.of(config, num_frames)
    cube = RadarCube(values=np.concatenate(parts), grid=grid, config=config, scale=1.0)
    joints, velocity = _at_frames(pose, grid, config)
    return MadeSequence(spec=spec, cube=cube, joints_m=joints, joint_velocity_mps=velocity)


def _at_frames(pose: PoseSequence, grid: CubeGrid, config: RadarConfig) -> tuple[np.ndarray, np.ndarray]:
    """Joints and their velocities at the middle of each frame, (frame, 22, 3)."""
    return joints_and_velocities(pose, grid.frame_time_s + config.active_time_s / 2)


def pose_of(spec: SequenceSpec, scene: Scene, config: RadarConfig, num_frames: int) -> PoseSequence:
    """The person's motion in the scene. Raises InputError where none of a few tries finds a place."""
    window = (float(config.range_m[0]), float(config.range_m[-1]))
    plan = plan_motion(spec.text, num_frames * config.frame_period_s)
    for attempt in range(RETRIES):
        try:
            motion = compose(
                plan, scene, seed=spec.seed + attempt, range_window_m=window, height_m=PEOPLE_HEIGHT_M[spec.person]
            )
            return replace(motion.pose, subject=spec.person)
        except InputError:
            if attempt == RETRIES - 1:
                raise
    raise AssertionError("unreachable")


def _empty(simulator: Simulator) -> np.ndarray:
    """(range, antenna) of the room alone: the range transform of what stays."""
    from mmweaver.core.records import AdcCube

    config = simulator.config
    samples = np.repeat(simulator.room_adc[None, None], config.num_loops, axis=1).astype(np.complex64)
    cube = radar_cube(AdcCube(samples=samples, config=config, scale=1.0))
    return cube.values[0, :, config.num_loops // 2]
