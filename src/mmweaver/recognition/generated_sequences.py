"""Generated recordings of a task: people of a population perform its sentences in front of its radar.

Sequences are stored in a folder as they are made, so an interrupted run resumes with the same bits.

Points that a board, possibly tilted, reports of people in a random scene: ray-traced samples, clutter, firmware.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Complex

from mmweaver.core.atomic_files import atomic_file, create_once
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import NOBODY
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.skin_scattering import LAMBERT, SkinEcho
from mmweaver.propagation.static_paths import AS_PUBLISHED
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.random_scene import Variation, VariationSample, closed_room, random_scene
from mmweaver.recognition.subject_simulation import (
    PerformancePrior,
    Performer,
    perform,
    performer,
    task_variation,
)
from mmweaver.recognition.task_file import RECORDED, RecognitionTask, RecordingSettings
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from
from mmweaver.signal.firmware import firmware_points
from mmweaver.signal.firmware_cfar import counts_per_db

BEHIND_M = 0.3  # minimum distance of a wall from the body
AT_M = 2.0  # range at which the level of diffuse clutter is specified
NEAREST_M = 0.3
LOSS_DB = (4.0, 8.0)  # of recorded boards relative to their link budget (core.boards.GAIN_DB)
CLOTHES_DB = (-3.0, 3.0)


@dataclass(frozen=True, kw_only=True)
class PointRadar:
    """A radar, the firmware that computes its points, the number of skin points, and the kind of clouds."""

    radar: RadarConfig
    firmware: FirmwareSettings
    skin_points: int
    as_recorded: bool = False  # levels, skin and rooms that give recorded clouds, instead of wide ranges


def observed_cloud(
    board: PointRadar, now: VariationSample, pose: PoseSequence | Sequence[PoseSequence], frames: int, seed: int
) -> PointCloud:
    """Points of one person, several, or an empty room, under sampled conditions.

    Args:
        board: Radar and firmware.
        now: Room, mount, noise and skin.
        pose: Motion in the radar's level axes; an empty tuple for an empty room.
        frames: Number of frames, from time 0.
        seed: Seed of noise, speckle and clutter.

    Returns:
        Points in the axes of the board, which is tilted down by `tilt_deg`.
    """
    radar = replace(
        board.radar,
        noise_figure_db=board.radar.noise_figure_db + now.noise_db,
        rx_gain_db=board.radar.rx_gain_db + now.gain_db,
        elevation_beamwidth_deg=now.elevation_beamwidth_deg,
    )
    people = (pose,) if isinstance(pose, PoseSequence) else tuple(pose)
    echo, wall_m = _skin(now), now.wall_m
    if board.as_recorded:
        rng = stream(seed, "as recorded")
        places = np.concatenate([np.zeros((0, 2)), *(one.joints_m[..., :2].reshape(-1, 2) for one in people)])
        room = closed_room(floor_z_m=-now.radar_height_m, people_m=places, panels=now.panels, rng=rng)
        radar, echo = replace(radar, noise_figure_db=radar.noise_figure_db + rng.uniform(*LOSS_DB)), _recorded_skin(rng)
    else:
        if wall_m is not None and isinstance(pose, PoseSequence):
            wall_m = max(wall_m, float(pose.joints_m[..., 1].max()) + BEHIND_M)
        room = random_scene(floor_z_m=-now.radar_height_m, wall_y_m=wall_m, panels=now.panels)
    looks = RadarPose(pitch_deg=-now.tilt_deg)
    scene = scene_seen_from(room, looks)
    clutter = diffuse_clutter(radar, now.clutter_db, stream(seed, "diffuse clutter"))
    firmware = _less_sensitive(board.firmware, now.threshold_db, board.radar.num_antennas)
    adc = (
        Simulator(scene, radar, propagation=AS_PUBLISHED).run(
            people_seen_from(people, looks), num_frames=frames, seed=seed, num_points=board.skin_points, echo=echo
        )
    ).adc
    return firmware_points(replace(adc, samples=adc.samples + clutter), firmware)


def _less_sensitive(settings: FirmwareSettings, by_db: float, num_antennas: int) -> FirmwareSettings:
    """Settings with CFAR thresholds raised by `by_db`, in counts of the device."""
    counts = round(by_db * counts_per_db(settings.device, num_antennas))
    cfars = (settings.range_cfar, settings.doppler_cfar)
    high, low = (None if cfar is None else replace(cfar, threshold=cfar.threshold + counts) for cfar in cfars)
    return replace(settings, range_cfar=high, doppler_cfar=low)


def _skin(now: VariationSample) -> SkinEcho:
    """A lobe of cos^exponent with the total reflected power of Lambertian skin of the sampled albedo."""
    exponent = now.skin_exponent
    reflectivity = 8 / 3 * (exponent + 1) / exponent * LAMBERT.albedo * 10 ** (now.albedo_db / 10)
    return SkinEcho(
        reflectivity=reflectivity, slope=exponent**-0.5, albedo=0.0, arms_db=now.arms_db, legs_db=now.legs_db
    )


def _recorded_skin(rng: np.random.Generator) -> SkinEcho:
    """Skin as fitted to recorded signals, with a spread between clothes."""
    usual = SkinEcho()
    return replace(
        usual,
        reflectivity=usual.reflectivity * 10 ** (rng.uniform(*CLOTHES_DB) / 10),
        arms_db=usual.arms_db + rng.uniform(*CLOTHES_DB),
        legs_db=usual.legs_db + rng.uniform(*CLOTHES_DB),
    )


def diffuse_clutter(
    config: RadarConfig, level_db: float, rng: np.random.Generator
) -> Complex[np.ndarray, "tx rx sample"]:
    """ADC samples of static echoes at every range, identical in all chirps and frames, sqrt(mW).

    No real room is empty: they fill the zero-Doppler column and raise the noise estimate of its CFAR; of moving points
    only the slowest are masked. A stationary body interferes with them: where both share a range bin they add
    coherently, and the body's points come and go.

    `level_db` is their power in a range bin at 2 m relative to the thermal noise of one chirp in that bin. It falls as
    1/R^2 (the clutter area of a range bin grows as R^2, and each echo falls as 1/R^4). Phases of different antennas are
    independent, for the echoes come from all directions.
    """
    bins = config.num_samples
    range_m = np.arange(bins) * config.range_resolution_m
    share = np.where(range_m > NEAREST_M, AT_M / np.maximum(range_m, NEAREST_M), 0.0)
    samples = rng.standard_normal((config.num_tx, config.num_rx, bins, 2)).view(np.complex128)[..., 0] / np.sqrt(2)
    # noise of one sample has power p, and p / bins in each of the bins of a normalised spectrum
    amplitude = np.sqrt(config.noise_power_mw / bins * 10 ** (level_db / 10)) * share
    return (np.fft.ifft(samples * amplitude, axis=-1) * bins).astype(np.complex64)


WINDOWS_PER_SEQUENCE, SHORTEST_S, LONGEST_S = 2, 4.0, 20.0
TRIES, UNSEEN_TRIES = 12, 2
REACH_M, SEEN_SHARE = 0.6, 0.3  # of the body around the pelvis; share of frames in which it must be detected
SKIN_POINTS = 1000
VERSION = 8  # of how sequences are made; part of what a folder of them must agree in
COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")


@dataclass(frozen=True, kw_only=True)
class SequenceRecipe:
    """Everything that determines generated sequences of a task, except their number."""

    task: RecognitionTask
    prior: PerformancePrior
    variation: Variation
    seed: int = 0
    as_recorded: bool = False  # as in `PointRadar`

    @staticmethod
    def of(task: RecognitionTask, prior: PerformancePrior | None = None, seed: int = 0) -> "SequenceRecipe":
        """The recipe of a task.

        Args:
            task: The task.
            prior: How people and performances differ; by default `PerformancePrior()`.
            seed: Seed of everything that is sampled.
        """
        return SequenceRecipe(
            task=task,
            prior=prior or PerformancePrior(),
            variation=task_variation(task.mount),
            seed=seed,
            as_recorded=task.clouds == RECORDED,
        )

    @property
    def board(self) -> PointRadar:
        """The task's radar and firmware."""
        return PointRadar(
            radar=self.task.radar,
            firmware=self.task.firmware,
            skin_points=SKIN_POINTS,
            as_recorded=self.as_recorded,
        )

    @property
    def seconds(self) -> float:
        """Duration of a sequence of a continuing activity in seconds."""
        return float(np.clip(WINDOWS_PER_SEQUENCE * self.task.recordings.window_s, SHORTEST_S, LONGEST_S))

    def as_json(self) -> str:
        """Everything that determines the bits of a sequence; equal recipes give equal text."""
        task = self.task
        values: dict[str, Any] = {
            "version": VERSION,
            "seed": self.seed,
            "skin_points": SKIN_POINTS,
            "prior": asdict(self.prior),
            "variation": asdict(self.variation),
            "activities": task.activities,
            "window_s": task.recordings.window_s,
            "frame_rate_hz": task.recordings.frame_rate_hz,
            "once": task.recordings.has_single_performances,
            "radar": parse_json(task.radar.to_json(), "the radar"),
            "firmware": {name: value for name, value in asdict(task.firmware).items() if name != "substitute"},
        }
        if self.as_recorded:
            values["clouds"] = RECORDED
        return json.dumps(values, sort_keys=True) + "\n"


def generate_sequence(recipe: SequenceRecipe, label: str, index: int) -> PointRecording:
    """The recording of the index-th person performing an activity.

    Args:
        recipe: The recipe.
        label: The activity.
        index: Number of the person.

    Raises:
        InputError: If its sentences cannot be carried out.
    """
    rng = stream(recipe.seed, "performance", label, index)
    sentences = recipe.task.activities[label]
    unseen: list[PointRecording] = []
    refused: InputError | None = None
    for attempt in range(TRIES):
        who = performer(recipe.prior, recipe.variation, index + attempt * 100_003, recipe.seed)
        if sentences == (NOBODY,):
            frames = max(int(recipe.seconds * recipe.task.recordings.frame_rate_hz), 1)
            cloud = observed_cloud(recipe.board, who.surroundings, (), frames, who.subject + index)
            return _recording(recipe.task.recordings, label, index, cloud, frames)
        sentence = sentences[(index + attempt) % len(sentences)]
        try:
            sequence, is_seen = _sequence(recipe, who, sentence, label, index, rng)
        except InputError as error:
            refused = error
            continue
        if is_seen or len(unseen) == UNSEEN_TRIES:
            return sequence
        unseen.append(sequence)
    if unseen:
        return unseen[-1]
    raise refused or InputError(f"no sequence of {label!r} could be generated")


def _sequence(
    recipe: SequenceRecipe, who: Performer, sentence: str, label: str, index: int, rng: np.random.Generator
) -> tuple[PointRecording, bool]:
    """A sequence, and whether the body is detected often enough; otherwise a real radar would be placed elsewhere."""
    once, rate_hz = recipe.task.recordings.has_single_performances, recipe.task.recordings.frame_rate_hz
    did = perform(who, recipe.prior, sentence, seconds=recipe.seconds, once=once, rng=rng)
    frames, pose = max(int(did.lasts_s * rate_hz), 1), did.pose
    cloud = observed_cloud(recipe.board, did.surroundings, pose, frames, int(rng.integers(2**31)))
    body_m = np.interp(cloud.frame / rate_hz, pose.time_s, np.linalg.norm(pose.joints_m[:, joint("pelvis")], axis=1))
    seen = len(np.unique(cloud.frame[np.abs(cloud.range_m - body_m) < REACH_M]))
    joints_m = joints_at(pose, np.arange(frames) / rate_hz)
    return _recording(recipe.task.recordings, label, index, cloud, frames, joints_m), seen >= SEEN_SHARE * frames


def _recording(
    settings: RecordingSettings,
    label: str,
    index: int,
    cloud: PointCloud,
    frames: int,
    joints_m: np.ndarray | None = None,
) -> PointRecording:
    return PointRecording(
        name=f"{label}_{index}",
        cloud=cloud,
        num_frames=frames,
        frame_rate_hz=settings.frame_rate_hz,
        label=label,
        joints_m=joints_m,
    )


def joints_at(pose: PoseSequence, time_s: np.ndarray) -> np.ndarray:
    """Joints of a motion, linearly interpolated.

    Args:
        pose: The motion.
        time_s: Times (time,) in seconds.

    Returns:
        Joints (time, 22, 3) in metres.
    """
    before = np.searchsorted(pose.time_s, time_s).clip(1, len(pose.time_s) - 1)
    early_s, late_s = pose.time_s[before - 1], pose.time_s[before]
    share = ((time_s - early_s) / (late_s - early_s)).clip(0, 1)[:, None, None]
    return (1 - share) * pose.joints_m[before - 1] + share * pose.joints_m[before]


def generate_sequences(
    recipe: SequenceRecipe, each: int, folder: Path | None = None, listener: Callable[[int, int], object] | None = None
) -> list[PointRecording]:
    """Generated recordings of all activities of a task.

    Args:
        recipe: The task, with everything else that determines the sequences.
        each: Number of people who perform every activity.
        folder: Folder from which sequences are read and where new ones are stored.
        listener: Called with the number of finished sequences and the total.

    Returns:
        Recordings, person by person.

    Raises:
        InputError: If the folder belongs to another recipe, or sentences cannot be carried out.
    """
    if folder is not None and create_once(folder / "recipe.json", recipe.as_json()) != recipe.as_json():
        raise InputError(f"{folder} holds sequences of another task or seed; choose another folder or remove it")
    settings, sequences = recipe.task.recordings, list[PointRecording]()
    for index, (number, label) in product(range(each), enumerate(settings.labels)):
        place = None if folder is None else folder / f"{number:03d}_{index:05d}.npz"
        if place is not None and place.is_file():
            sequences.append(_read(place, settings, label, index))
        else:
            sequences.append(generate_sequence(recipe, label, index))
            if place is not None:
                _write(place, sequences[-1])
        if listener is not None:
            listener(len(sequences), each * len(settings.labels))
    return sequences


def _write(place: Path, sequence: PointRecording) -> None:
    cloud = sequence.cloud
    columns = np.stack([getattr(cloud, name) for name in COLUMNS], axis=1).astype(np.float32)
    arrays: dict[str, Any] = {} if sequence.joints_m is None else {"joints_m": sequence.joints_m.astype(np.float32)}
    with atomic_file(place) as temporary, temporary.open("wb") as file:
        np.savez_compressed(
            file,
            frame=cloud.frame.astype(np.int32),
            columns=columns,
            num_frames=np.int64(sequence.num_frames),
            **arrays,
        )


def _read(place: Path, settings: RecordingSettings, label: str, index: int) -> PointRecording:
    held = read_npz(place)
    frames = int(held.numbers("num_frames", (), low=1, high=1e6))
    frame = held.numbers("frame", ("point",), kinds="iu", low=0, high=frames - 1).astype(int)
    columns = held.numbers("columns", ("point", len(COLUMNS)), nan=True).astype(float)
    joints_m = held.numbers("joints_m", (frames, 22, 3)).astype(float) if "joints_m" in held else None
    cloud = PointCloud(frame=frame, **dict(zip(COLUMNS, columns.T, strict=True)))
    return _recording(settings, label, index, cloud, frames, joints_m)
