"""Can recorded signals be told from simulated ones by a classifier that never saw their board?

    python -m studies run board_left_out --data <recordings>

Fixed before any score was looked at. Three recordings by three boards: two people who move (openradar_two_people), a
hall (iwr6843_dca1000), a person who breathes (bgt60_breathing). Each is simulated with its radar in six rooms (the
bundled one, four photographed ones, a procedural office): two walkers at the places of the recorded ones, or as far
along the same directions as the room lets them be seen, nobody, a person who breathes at 0.33 m; each four times, with
other boards, clutter and people. Units are quarters of the single frames, and runs of 32 frames of the third. Of each
unit all features of `mmweaver compare` are measured. Trees learn recorded or
simulated from two boards and judge the third; accuracy is the mean of the shares of recorded and of simulated units
that are right, its interval a bootstrap over units. 0.5 is chance, and what trees reach that call everything simulated;
so the ranking (area under the curve) stands next to it, and that of each feature alone.
Two conditions: `before`, paths of first order, resolved clutter, one reflection coefficient, ideal board; `after`, the
physics as `generate` runs it, with a typical board and the clutter sampled by the room.

What was wrong in earlier runs and was mended: walkers stood behind furniture and walls in two rooms; then each stood
where it was seen, so that in two rooms one walked 0.5 to 0.7 m behind the other and was counted as the echo behind it
(the recorded two are equally far); the person who breathes stood sideways; all radars sent 12 dBm, the third one's own
are 5; simulations alone had a known amplitude scale, which a feature shows; one board a room, so that six stood for
all. All three boards served for development, so `after` is blind to none of them.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import BGT60, find_board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import AdcCube, PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.evaluation.compare_signals import FEATURES
from mmweaver.evaluation.signal_evidence import CannotSeeError, ComparedSignal, SignalEvidence
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import AS_PUBLISHED, Propagation
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube
from studies.fields.field_signals import pose_of, sample_scene
from studies.manifest import StudyRun
from studies.physics.signal_statistics import (
    breathing_pose,
    recorded_hall,
    recorded_people,
)
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from studies.result_rows import complete_rows
from studies.study import Reads

PHOTOS = ("kinect2_living_room", "kinect_dining_room", "redwood_chair_corner", "tum_office_desk")
WALKERS_RAD, WALKERS_M = np.radians([-15.0, 8.0]), 2.93
CHESTS_M, STEP_BEFORE_M, NEAREST_M = np.array([0.9, 1.1, 1.3, 1.5]), 0.5, 1.0
RUN_FRAMES, SIMULATED_RUNS = 32, 2
DRAWS = 4  # of board, clutter and people in each room: six boards alone happened to lie within half of their spread
CONDITIONS = {"before": AS_PUBLISHED, "after": Propagation(clutter=True)}
SETTINGS = ClassifierSettings(num_trees=300, boosting_rounds=80, leaf_size=2)
Units = np.ndarray  # (unit, feature), nan where a unit does not show one


def rooms_of(data: Path) -> dict[str, Scene]:
    """The six rooms by name."""
    rooms = {"bundled": sample_scene(), "procedural_office": make_room("office", 0, 0).scene()}
    for name in PHOTOS:
        folder = data / "rooms" / name
        photo, notes = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
        rooms[name] = reconstruct(photo, assumptions=notes)
    return rooms


def units_of(adc: AdcCube) -> Units:
    """Features of the quarters of a single frame, or of runs of frames."""
    if len(adc.samples) == 1:
        whole = SignalEvidence(ComparedSignal(name="", cube=radar_cube(adc), adc=adc)).quarters()
        assert whole is not None
        return np.stack([_values(feature, whole, 4) for feature in FEATURES], axis=1)
    runs = [replace(adc, samples=adc.samples[at : at + RUN_FRAMES]) for at in range(0, len(adc.samples), RUN_FRAMES)]
    each = [SignalEvidence(ComparedSignal(name="", cube=radar_cube(run), adc=run)) for run in runs]
    return np.array([[_values(feature, one, 1)[0] for feature in FEATURES] for one in each])


def _values(feature: Any, evidence: SignalEvidence, count: int) -> np.ndarray:
    """Of each unit (count,), or the median in each."""
    try:
        with np.errstate(divide="ignore", invalid="ignore"):
            values = feature.measure(evidence).values
    except CannotSeeError:
        return np.full(count, np.nan)
    return values if len(values) == count > 1 else np.full(count, _middle(values))


def _middle(values: np.ndarray) -> float:
    """The median of those that are finite, nan if none is."""
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else np.nan


def walkers(scene: Scene, seed: int, moment_s: float = 0.0) -> tuple[PoseSequence, ...]:
    """Two people walking through the places of the recorded ones, one towards the radar and one away from it.

    `moment_s`: so much before or after the middle of the walk is the moment at which they are there.
    """
    people = []
    distance_m = walkers_m(scene)
    for index, towards in enumerate(_directions()):
        pose = pose_of("walking", seconds=2.0, seed=seed + 10 * index)
        middle = int(np.abs(pose.time_s - pose.time_s[len(pose.time_s) // 2] - moment_s).argmin())
        joints_m = pose.joints_m - pose.joints_m[middle, 0] * np.array([1.0, 1.0, 0.0])
        if index:
            joints_m = joints_m * np.array([-1.0, -1.0, 1.0])
        place = distance_m * towards
        up = scene.floor_z_m - float(joints_m[..., 2].min())
        moved = joints_m + np.array([*place, up])
        people.append(replace(pose, time_s=pose.time_s - pose.time_s[middle], joints_m=moved, subject=seed + index))
    return tuple(people)


def walkers_m(scene: Scene) -> float:
    """How far from the radar both walkers are: equally far, or one is the other's echo behind."""
    return min(_seen_m(scene, towards) for towards in _directions())


def _directions() -> list[np.ndarray]:
    """Unit vectors (2,) on the floor towards the walkers."""
    return [np.array([np.sin(azimuth), np.cos(azimuth)]) for azimuth in WALKERS_RAD]


def _seen_m(scene: Scene, towards: np.ndarray) -> float:
    """How far along a direction (2,) somebody walks: as recorded, or before what stands there at chest height."""
    caster = RayCaster(scene.vertices_m, scene.faces)
    height_m = scene.floor_z_m + CHESTS_M  # above and below, too: somebody behind a table is seen
    ends = np.column_stack([np.tile(WALKERS_M * towards, (len(height_m), 1)), height_m])
    distance = np.linalg.norm(ends, axis=1)
    free = np.minimum(caster.distance_m(np.zeros_like(ends), ends / distance[:, None]) / distance, 1.0) * WALKERS_M
    clear = float(free.max())
    return WALKERS_M if clear >= WALKERS_M else max(clear - STEP_BEFORE_M, NEAREST_M)


def breather(seed: int, frames: int) -> tuple[PoseSequence, ...]:
    """Somebody who stands with the chest 0.33 m ahead of the radar, facing it, and only breathes."""
    return (breathing_pose(seed, frames)[0],)


def simulated(
    scene: Scene, config: RadarConfig, people: tuple[PoseSequence, ...], frames: int, condition: str, seed: int
) -> AdcCube:
    """A recording of people in a room."""
    board = find_board("typical", config, seed) if condition == "after" else None
    simulator = Simulator(scene, config, micro_seed=seed, propagation=CONDITIONS[condition], board=board)
    return recorded_by(simulator, people, frames, seed)


def recorded_by(simulator: Simulator, people: tuple[PoseSequence, ...], frames: int, seed: int) -> AdcCube:
    """What a radar in a room records, of no known scale, as recordings come: a known one is no feature of a signal."""
    return replace(simulator.run(people, num_frames=frames, seed=seed).adc, scale=np.nan)


def recorded_breath(data: Path) -> AdcCube:
    path = data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    return read_adc_npy(path, BGT60, "frame,rx,loop,sample")


BOARDS: dict[str, tuple[Callable[[Path], AdcCube], Callable[[Scene, int], tuple[PoseSequence, ...]], int]] = {
    "openradar_two_people": (recorded_people, walkers, 1),
    "iwr6843_hall": (recorded_hall, lambda scene, seed: (), 1),
    "bgt60_breathing": (
        recorded_breath, lambda scene, seed: breather(seed, RUN_FRAMES * SIMULATED_RUNS), RUN_FRAMES * SIMULATED_RUNS,
    ),
}  # fmt: skip


def chances(real: dict[str, Units], made: dict[str, Units], left_out: str) -> tuple[np.ndarray, np.ndarray]:
    """Probability of "recorded" for the recorded and the simulated units of one board, by what the others taught."""
    others = [name for name in real if name != left_out]
    learned = np.concatenate([*(real[name] for name in others), *(made[name] for name in others)])
    counts = [sum(len(part[name]) for name in others) for part in (real, made)]
    labels = np.repeat(["recorded", "simulated"], counts)
    shown = np.isfinite(learned).any(axis=0)
    trees = ActivityClassifier(SETTINGS).fit(learned[:, shown], labels)
    of_recorded, of_made = (trees.probabilities(part[left_out][:, shown])[:, 0] for part in (real, made))
    return of_recorded, of_made


def verdicts(of_recorded: np.ndarray, of_made: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which recorded and which simulated units are right, of their probabilities of "recorded"."""
    return of_recorded >= 0.5, of_made < 0.5


def ranking(of_recorded: np.ndarray, of_made: np.ndarray) -> dict[str, Any]:
    """How often a recorded unit has the higher probability of the two: the area under the curve."""
    return {
        "value": _above(of_recorded, of_made), "unit": "1", "baseline": {"chance": 0.5},
        "definition": "how often a recorded unit has a higher probability of being recorded than a simulated one",
    }  # fmt: skip


def _above(recorded: np.ndarray, made: np.ndarray) -> float:
    """How often one of the first is larger than one of the second."""
    return float((recorded[:, None] > made).mean() + 0.5 * (recorded[:, None] == made).mean())


def alone(recorded: Units, made: Units) -> dict[str, Any]:
    """The ranking by each feature that both show."""
    metrics = {}
    for feature, *pair in zip(FEATURES, recorded.T, made.T, strict=True):
        real, other = (values[np.isfinite(values)] for values in pair)
        if len(real) and len(other):
            metrics[f"by_{feature.name}"] = {
                "value": _above(real, other), "unit": "1", "baseline": {"chance": 0.5},
                "recorded_median": _middle(real), "simulated_median": _middle(other),
                "definition": f"how often a recorded unit has more than a simulated one: {feature.definition}",
            }  # fmt: skip
    return metrics


def accuracy(right: tuple[np.ndarray, np.ndarray]) -> dict[str, Any]:
    """Mean share of both kinds, and its interval over units."""
    rng = stream(0, "bootstrap")
    draws = [np.mean([part[rng.integers(len(part), size=len(part))].mean() for part in right]) for _ in range(2000)]
    low, high = np.percentile(draws, [2.5, 97.5])
    return {
        "value": float(np.mean([part.mean() for part in right])), "interval_95": [float(low), float(high)], "unit": "1",
        "baseline": {"chance": 0.5},
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder with radar/ and rooms/ in it")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rooms = rooms_of(options.data)
    recordings = {name: read(options.data) for name, (read, _, _) in BOARDS.items()}
    real = {name: units_of(adc) for name, adc in recordings.items()}
    rows: list[dict[str, Any]] = []
    for condition in CONDITIONS:
        whole: dict[str, Units] = {}
        for board, (_, people, frames) in BOARDS.items():
            config = recordings[board].config
            seeds = [
                (scene, seed + len(rooms) * draw) for draw in range(DRAWS) for seed, scene in enumerate(rooms.values())
            ]
            each = [simulated(scene, config, people(scene, seed), frames, condition, seed) for scene, seed in seeds]
            whole[board] = np.concatenate([units_of(adc) for adc in each])
        for board in BOARDS:
            found = chances(real, whole, board)
            metrics = {"accuracy": accuracy(verdicts(*found)), "ranking": ranking(*found)}
            metrics |= alone(real[board], whole[board])
            rows.append({"method": f"{condition}, {board} left out", "n": sum(map(len, found)), "metrics": metrics})
    names = list(rooms)
    unknown = {"seconds": "see the manifest", "dataset.sha256": "recordings are hashed in the manifest"}
    dataset = {"name": "three recordings, six rooms"}
    rows = complete_rows(rows, dataset=dataset, seeds=list(range(len(rooms))), unknown=unknown)
    run.write("board_left_out", "physics", config={"rooms": names}, rows=rows)
