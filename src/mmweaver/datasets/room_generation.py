"""Generates one room of a data set: its photo and the radar signals of its sequences."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PoseSequence, RadarCube, RgbdPhoto, Scene
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M, RoomSpec, SequenceSpec
from mmweaver.motion.animation.root_path import joints_and_velocities
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.people import Person
from mmweaver.propagation.diffuse_clutter import seed_of_room
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS, FIRST_ORDER, PreparedRoom, Propagation, RayTracedRoom
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube

RETRIES = 5  # attempts to place a motion in a room


@dataclass(frozen=True, kw_only=True)
class GeneratedSequence:
    """Joints at the middle of each frame, and the signal or the trace from which `propagation.resynthesis` makes it."""

    spec: SequenceSpec
    joints_m: np.ndarray  # (frame, 22, 3) float32
    joint_velocity_mps: np.ndarray  # (frame, 22, 3) float32
    cube: RadarCube | None = None  # in sqrt(mW)
    trace: tuple[np.ndarray, Visibility] | None = None  # joints at the clock's nodes (frame, node, 22, 3) float32


@dataclass(frozen=True, kw_only=True)
class RoomGeometry:
    """Ray-traced static paths of the true scene, and of the scene reconstructed from its photo."""

    room: PreparedRoom
    photographed: PreparedRoom


@dataclass(frozen=True, kw_only=True)
class GeneratedRoom:
    """A room with its sequences; `refused` lists index and reason of each sequence that does not fit.

    With `geometry` the sequences have traces, otherwise cubes.
    """

    spec: RoomSpec
    photo: RgbdPhoto
    static: np.ndarray  # complex64 (range, antenna), static clutter at the peak of zero Doppler, sqrt(mW)
    sequences: tuple[GeneratedSequence, ...]
    refused: tuple[tuple[int, str], ...]
    geometry: RoomGeometry | None = None


def generate_room(
    spec: RoomSpec,
    config: RadarConfig,
    num_frames: int,
    *,
    geometry_only: bool = False,
    board: Board = IDEAL_BOARD,
    propagation: Propagation = ALL_PATHS,
    take_cube: Callable[[RadarCube], object] | None = None,
) -> GeneratedRoom:
    """Generates a room and simulates all its sequences with one board; about 0.35 CPU seconds per sequence.

    Args:
        spec: The room with its sequences.
        config: The radar.
        num_frames: Frames per sequence.
        geometry_only: Whether only first-order geometry is traced, in a third of the time, from which signals are
            synthesised later. Default: False.
        board: Board of all signals. Default: ideal.
        propagation: Paths that are simulated. Default: all, including second order and clutter.
        take_cube: Called with the cube of each sequence, which the room then does not hold. Default: it holds them.

    Returns:
        The room.
    """
    room = make_room(spec.kind, spec.layout, spec.seed)
    true_scene = room.scene(spec.lighting)
    simulator = Simulator(
        true_scene,
        config,
        board=board,
        micro_seed=seed_of_room(true_scene),
        propagation=FIRST_ORDER if geometry_only else propagation,
    )
    photo = room.photo(spec.lighting, noise=True)
    made, refused = [], []
    for sequence in spec.sequences:
        try:
            one = generate_sequence(sequence, true_scene, simulator, num_frames, geometry_only=geometry_only)
        except InputError as error:
            refused.append((sequence.index, str(error)))
            continue
        if take_cube is not None and one.cube is not None:
            take_cube(one.cube)
            one = replace(one, cube=None)
        made.append(one)
    return GeneratedRoom(
        spec=spec,
        photo=photo,
        static=_static_clutter(simulator),
        sequences=tuple(made),
        refused=tuple(refused),
        geometry=_geometry(simulator, photo) if geometry_only else None,
    )


def _geometry(simulator: Simulator, photo: RgbdPhoto) -> RoomGeometry:
    stored = replace(
        photo, depth_m=photo.depth_m.astype(np.float32).astype(np.float64)
    )  # precision of the stored depth
    return RoomGeometry(
        room=simulator.room, photographed=RayTracedRoom(reconstruct(stored), simulator.config, propagation=FIRST_ORDER)
    )


def generate_sequence(
    spec: SequenceSpec,
    scene: Scene,
    simulator: Simulator,
    num_frames: int,
    *,
    geometry_only: bool = False,
    subject: int | None = None,
    noise_seed: int | None = None,
) -> GeneratedSequence:
    """Simulates one sequence, or traces it without its signal.

    Args:
        spec: Activity, person and seed.
        scene: The true room.
        simulator: Simulator of room and radar.
        num_frames: Number of radar frames.
        geometry_only: Whether it is only traced. Default: False.
        subject: Body surface of another realization. Default: the person's.
        noise_seed: Seed of the noise. Default: that of the sequence.

    Returns:
        Joints, and the cube in sqrt(mW) or the trace.

    Raises:
        InputError: If the motion does not fit the room.
    """
    config, grid = simulator.config, CubeGrid.of(simulator.config, num_frames)
    pose = pose_of(spec, scene, config, num_frames)
    joints_m, velocity_mps = joints_and_velocities(pose, grid.frame_time_s + config.active_time_s / 2)
    found = GeneratedSequence(spec=spec, joints_m=joints_m, joint_velocity_mps=velocity_mps)
    if geometry_only:
        return replace(found, trace=simulator.trace(pose, num_frames=num_frames, seed=spec.seed))
    if subject is not None:
        pose = replace(pose, subject=subject)
    seed = spec.seed if noise_seed is None else noise_seed
    parts = [radar_cube(chunk).values for chunk in simulator.chunks(pose, num_frames=num_frames, seed=seed)]
    return replace(found, cube=RadarCube(values=np.concatenate(parts), grid=grid, config=config, scale=1.0))


def pose_of(spec: SequenceSpec, scene: Scene, config: RadarConfig, num_frames: int) -> PoseSequence:
    """Composes the person's motion in a scene.

    Args:
        spec: Activity, person and seed.
        scene: The room.
        config: The radar.
        num_frames: Number of radar frames.

    Returns:
        The motion.

    Raises:
        InputError: If it does not fit in five attempts.
    """
    window = (float(config.range_m[0]), float(config.range_m[-1]))
    plan = plan_motion(spec.text, num_frames * config.frame_period_s)
    for attempt in range(RETRIES):
        try:
            motion = compose(
                plan,
                scene,
                seed=spec.seed + attempt,
                range_window_m=window,
                person=Person(height_m=PEOPLE_HEIGHT_M[spec.person]),
                is_varied=False,
                may_touch=False,
            )
            return replace(motion.pose, subject=spec.person)
        except InputError:
            if attempt == RETRIES - 1:
                raise
    raise AssertionError("unreachable")


def _static_clutter(simulator: Simulator) -> np.ndarray:
    """Range spectrum (range, antenna) of the room's static paths, complex64, sqrt(mW)."""
    config = simulator.config
    samples = np.repeat(simulator.room_adc[None, None], config.num_loops, axis=1).astype(np.complex64)
    cube = radar_cube(AdcCube(samples=samples, config=config, scale=1.0))
    return cube.values[0, :, config.num_loops // 2]
