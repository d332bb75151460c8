"""The recipe of the older recogniser of RadHAR's activities: sentences and habits -> generated windows.

A task file (docs/recognise.md) replaced it. It makes what the studies zero_shot_* train on.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.boards import IWR1443_RADHAR
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FIRMWARE, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.compose import compose
from mmweaver.motion.language.sentence import parse_sentence
from mmweaver.motion.language.timing import schedule
from mmweaver.motion.people import Person
from mmweaver.recognition.generated_sequences import PointRadar, observed_cloud
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.random_scene import Span, Variation, VariationSample, random_scene, sample_variation
from mmweaver.recognition.subject_simulation import (
    SLOWEST_MPS,
    pelvis_speed_mps,
    scaled_excursion,
    sway_m,
    time_warped,
)

LEAD_S = 0.75  # least start of a window in the motion's own time: recordings do not begin at rest
TRIES, UNSEEN_TRIES = 20, 3
WITHIN_M = (0.55, 3.1)  # slant ranges of stationary people
BODY_REACH_M, SEEN_SHARE = 0.6, 0.5

ACTIVITIES = {
    "boxing": (
        "a person punches", "a person punches quickly", "a person punches with the right hand",
        "a person punches with the left hand",
    ),
    "jack": ("a person does jumping jacks", "a person does jumping jacks quickly", "jumping jacks slowly"),
    "jump": (
        "a person hops", "a person hops quickly", "a person hops slowly", "a person hops on the spot",
        "a person hops", "a person jumps",
    ),
    "squats": ("a person squats", "a person squats quickly", "a person squats slowly"),
    "walk": (
        "a person walks slowly back and forth", "a person walks back and forth", "a person walks slowly back and forth",
        "a person walks slowly towards the radar, turns around, walks slowly away, turns around and walks slowly"
        " towards the radar",
        "a person walks towards the radar, turns around, walks away, turns around and walks towards the radar",
        "a person walks slowly away, turns around and walks slowly towards the radar, turns around and walks slowly"
        " away",
        "a person walks away, turns around and walks towards the radar",
        "a person walks slowly away, stands, turns around and walks slowly towards the radar",
        "a person walks slowly away", "a person walks slowly towards the radar",
    ),
}  # fmt: skip

# How people moved in the inspected recordings, where the motion library differs.
HABITS = {
    "boxing": {"roam_mps": (0.0, 0.35), "vigour": (0.8, 1.5), "tempo": (0.8, 1.6)},  # they step to and fro
    "jack": {"vigour": (0.75, 1.3)},
    "jump": {"vigour": (0.65, 1.3), "roam_mps": (0.0, 0.1)},  # hops do not end where they began
    "squats": {"vigour": (0.4, 0.95), "tempo": (0.65, 1.4)},  # slow, and seldom deep
}


@dataclass(frozen=True, kw_only=True)
class GenerationRecipe:
    """Everything that determines the generated data: sentences per activity, radar and firmware, and variation."""

    activities: Mapping[str, tuple[str, ...]]
    radar: RadarConfig
    firmware: FirmwareSettings
    variation: Variation = Variation()  # noqa: RUF009 (frozen)
    habits: Mapping[str, Mapping[str, Span]] = field(
        default_factory=dict
    )  # ranges of single activities that override the variation, by name
    window_s: float = 2.0

    @property
    def frames(self) -> int:
        """Number of frames per window."""
        return max(round(self.window_s / self.radar.frame_period_s), 1)

    def variation_of(self, activity: str) -> Variation:
        """The ranges that windows of an activity are sampled from."""
        return replace(self.variation, **self.habits.get(activity, {}))

    def as_json(self) -> str:
        """All settings as JSON text; equal recipes give equal text."""
        return json.dumps(asdict(self), sort_keys=True)


def radhar_recipe() -> GenerationRecipe:
    """The IWR1443 at 30 frames per second and its five activities."""
    return GenerationRecipe(
        activities=ACTIVITIES, radar=IWR1443_RADHAR, firmware=FIRMWARE["iwr1443_radhar"], habits=HABITS
    )


def generate_window(recipe: GenerationRecipe, label: str, index: int, seed: int) -> PointRecording:
    """Generates the index-th window of an activity; deterministic in recipe, label, index and seed."""
    rng = stream(seed, "zero shot", label, index)
    own = recipe.variation_of(label)
    unseen: list[PointRecording] = []
    refused: InputError | None = None
    for _ in range(TRIES):
        now = sample_variation(own, rng)
        sentence = str(rng.choice(recipe.activities[label]))
        person = int(rng.integers(2**31))
        try:
            pose = _pose(recipe, now, sentence, person, rng)
        except InputError as error:
            refused = error
            continue
        window = _observed(recipe, now, pose, label, f"{label}_{index}", person)
        if _is_seen(window, pose) or len(unseen) == UNSEEN_TRIES:
            return window
        unseen.append(window)
    if unseen:
        return unseen[-1]
    raise refused or InputError(f"no window of {label!r} could be generated")


def _is_seen(window: PointRecording, pose: PoseSequence) -> bool:
    """Whether the body is detected in most frames: a radar that misses the person would be placed elsewhere."""
    time_s = np.arange(window.num_frames) / window.frame_rate_hz
    pelvis_m = pose.joints_m[:, joint("pelvis")]
    cloud = window.cloud
    body_m = np.interp(time_s, pose.time_s, np.linalg.norm(pelvis_m, axis=1))[cloud.frame]
    range_m = cloud.range_m
    there = cloud.frame[np.abs(range_m - body_m) < BODY_REACH_M]
    return len(np.unique(there)) >= SEEN_SHARE * window.num_frames


# the person ---------------------------------------------------------------------------------------------------------
def _pose(
    recipe: GenerationRecipe, now: VariationSample, sentence: str, person: int, rng: np.random.Generator
) -> PoseSequence:
    """A section of the motion at the sampled tempo, vigour and heading; time 0 is the first frame."""
    plan = parse_sentence(sentence)
    moves = any(step.moves for step in plan.steps)
    tempo = now.tempo * (recipe.variation.way_tempo if moves else 1.0)
    lasts_s = (recipe.frames * recipe.radar.frame_period_s + 0.1) * tempo  # of the motion's own time
    lead_s = LEAD_S + float(rng.uniform(0.0, 1.5))
    if moves:  # any part of the path
        lead_s = float(rng.uniform(LEAD_S, max(now.way_s - lasts_s, 2 * LEAD_S)))
    whole_s = max(now.way_s if moves else 0.0, lead_s + lasts_s + 0.5)
    scene = random_scene(floor_z_m=-now.radar_height_m, wall_y_m=None)
    start_m = None if moves and rng.random() < 0.5 else now.start_m
    pose = compose(
        schedule(plan, whole_s), scene, seed=person, range_window_m=now.reach_m if moves else WITHIN_M,
        start_m=start_m, person=Person(height_m=now.height_m), is_varied=False, may_touch=False,
    ).pose  # fmt: skip
    joints_m = scaled_excursion(pose.joints_m, now.vigour)
    if moves and tempo * pelvis_speed_mps(pose, lead_s, lead_s + lasts_s) < SLOWEST_MPS:
        raise InputError("the path ends before the window does")
    if not moves:
        joints_m = _rotated(joints_m, np.radians(now.turn_deg))
    joints_m = joints_m + sway_m(pose.time_s, now.roam_mps, rng)
    time_s = time_warped(pose.time_s - lead_s, tempo, now.hurry if moves else 0.0, rng)
    if time_s[-1] < recipe.frames * recipe.radar.frame_period_s:
        raise InputError("the path ends before the window does")
    return replace(pose, time_s=time_s, joints_m=joints_m, subject=person % 1000)


def _rotated(joints_m: np.ndarray, angle_rad: float) -> np.ndarray:
    """Joints (time, 22, 3) rotated about the vertical through the mean position of the pelvis."""
    axis = joints_m[:, joint("pelvis")].mean(axis=0) * np.array([1.0, 1.0, 0.0])
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    return (joints_m - axis) @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) + axis


# the radar ----------------------------------------------------------------------------------------------------------
def _observed(
    recipe: GenerationRecipe, now: VariationSample, pose: PoseSequence, label: str, name: str, person: int
) -> PointRecording:
    """The points that the firmware reports of the person in the sampled room."""
    board = PointRadar(radar=recipe.radar, firmware=recipe.firmware, skin_points=recipe.variation.skin_points)
    return PointRecording(
        name=name, cloud=observed_cloud(board, now, pose, recipe.frames, person), num_frames=recipe.frames,
        frame_rate_hz=1 / recipe.radar.frame_period_s, label=label,
    )  # fmt: skip


# the cache ----------------------------------------------------------------------------------------------------------
def write_window(path: Path, recording: PointRecording) -> None:
    """Writes one generated window to a cache."""
    cloud = recording.cloud
    columns = np.stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps, cloud.snr_db], axis=1)
    with atomic_file(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, frame=cloud.frame, columns=columns.astype(np.float32))


def read_window(path: Path, label: str, recipe: GenerationRecipe) -> PointRecording:
    """Reads a window of `write_window`."""
    held = read_npz(path)
    frame = held.numbers("frame", ("point",), kinds="iu")
    columns = held.numbers("columns", ("point", 5)).astype(float)
    names = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    cloud = PointCloud(frame=frame, **dict(zip(names, columns.T, strict=True)))
    return PointRecording(
        name=path.stem, cloud=cloud, num_frames=recipe.frames, frame_rate_hz=1 / recipe.radar.frame_period_s,
        label=label,
    )  # fmt: skip


def check_cache(cache: Path, recipe: GenerationRecipe) -> None:
    """Writes the recipe into a cache, or checks the existing one. Raises InputError for another recipe."""
    note = cache / "recipe.json"
    text = recipe.as_json()
    if note.exists() and read_text(note) != text:
        raise InputError(f"{cache} holds windows of another recipe; choose another folder or empty it")
    with atomic_file(note) as temporary:
        temporary.write_text(text, encoding="utf-8")
