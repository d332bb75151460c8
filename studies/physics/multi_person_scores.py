"""Mutual occlusion compared with plain superposition: what is lost by adding signals of people simulated one by one.

python -m studies run multi_person_scores --picture docs/images/several_people.png

Two people in the sample room, at given places, with all paths and the room's clutter; the ground truth is the
simulator with mutual occlusion, the prediction the sum of both simulated alone, with the same receiver noise. The
baseline leaves the second person out; oracles are the ground truth with other receiver noise, and another realization
of it (the same poses, other skins).
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, PoseSequence, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.micro_motion import STILL
from mmweaver.motion.multi_person import compose_people
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.points import point_cloud
from studies.fields.field_signals import OTHER_SKIN, sample_scene
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scores.scorecard import METRICS, Representations

SENTENCES = (
    "a person waves with the left hand", "someone does jumping jacks", "a man claps", "a woman squats",
    "he boxes quickly", "she waves with both hands",
)  # fmt: skip
Place = tuple[float, float]
ARRANGEMENTS: dict[str, tuple[Place, Place]] = {
    "side by side, 1.2 m apart": ((-0.55, 2.1), (0.65, 2.1)),
    "one behind the other, half aside": ((0.25, 1.5), (0.65, 2.5)),
    "one behind the other": ((-0.1, 1.35), (-0.15, 2.2)),
}
SHOWN = ("nmse_active_db", "nmse_moving_db", "rd_ssim", "ra_ssim", "chamfer_m", "hausdorff_m")
BASELINES, ORACLES = ("without_second",), ("mutual", "other_noise", "realization")
UNKNOWN = {
    "dataset.sha256": "simulated anew in every run",
    "seconds": "see the manifest: all rows together",
}
CONFIG = {"radar": AWR1843.name, "intervals": "95 % of the mean over pairs of people, bootstrap"}
NUM_FRAMES = 20
SPAN_DB = 50.0  # of the pictures, below the peak
SEEDS = tuple(range(16))
NEAR_M = 0.5  # a point so near to a pelvis, on the floor, is that person's
RESAMPLES = 2000
EXACT_DB = -150.0  # said where a prediction is the truth to the bit: minus infinity is no JSON


@dataclass(frozen=True, kw_only=True)
class Pair:
    """The signal of two people, made by every method that is compared."""

    poses: tuple[PoseSequence, PoseSequence]
    mutual: RadarCube
    plain: RadarCube
    without_second: RadarCube
    other_noise: RadarCube
    realization: RadarCube
    second_alone: RadarCube
    empty: RadarCube


def make_pair(simulator: Simulator, places: tuple[Place, Place], seed: int) -> Pair:
    """Samples two sentences and two bodies by the seed and simulates them. Raises InputError where they do not fit."""
    texts = [str(text) for text in stream(seed, "several people").choice(SENTENCES, 2, replace=False)]
    window_m = (float(AWR1843.range_m[0]), float(AWR1843.range_m[-1]))
    plans = [plan_motion(text, NUM_FRAMES * AWR1843.frame_period_s) for text in texts]
    people = compose_people(plans, sample_scene(), seed=seed, range_window_m=window_m, starts_m=places)
    one, two = people[0].pose, people[1].pose

    def cube(*people: PoseSequence, noise: int = seed) -> RadarCube:
        return radar_cube(simulator.run(people, num_frames=NUM_FRAMES, seed=noise, motions=STILL).adc)

    skins = [replace(pose, subject=pose.subject + OTHER_SKIN) for pose in (one, two)]
    first, second, empty = cube(one), cube(two), cube()
    return Pair(
        poses=(one, two), mutual=cube(one, two), without_second=first, second_alone=second, empty=empty,
        plain=replace(first, values=first.values + second.values - empty.values),  # with the receiver noise of one
        other_noise=cube(one, two, noise=seed + OTHER_SKIN), realization=cube(*skins),
    )  # fmt: skip


def scores_of(pair: Pair) -> dict[str, dict[str, float]]:
    """{metric: {superposition, without_second, ...}} against mutual occlusion; and its effects."""
    truth = Representations(pair.mutual)
    predictions = {
        "superposition": pair.plain, "without_second": pair.without_second, "other_noise": pair.other_noise,
        "realization": pair.realization,
    }  # fmt: skip
    views = {name: Representations(cube) for name, cube in predictions.items()}
    scores = {
        name: {who: max(METRICS[name].score(seen, truth), EXACT_DB) for who, seen in views.items()} for name in SHOWN
    }
    scores["second_dimmed_db"] = {"superposition": dimming_db(pair)}
    second = pair.poses[1]
    scores["points_of_second"] = {
        "mutual": points_near(point_cloud(pair.mutual), second),
        "superposition": points_near(point_cloud(pair.plain), second),
        "without_second": points_near(point_cloud(pair.without_second), second),
    }
    return scores


def dimming_db(pair: Pair) -> float:
    """Moving energy that the second person adds to the first, over that of the second person alone, in dB."""
    cubes = (pair.without_second, pair.mutual, pair.empty, pair.second_alone)
    first, both, empty, alone = (remove_static(cube).values for cube in cubes)
    added, own = both - first, alone - empty  # the same receiver noise in all: it cancels
    return 10 * float(np.log10((np.abs(added) ** 2).sum() / (np.abs(own) ** 2).sum()))


def points_near(points: PointCloud, pose: PoseSequence) -> float:
    """Detections per frame within NEAR_M of a person's pelvis, on the floor plane."""
    at_s = np.asarray(points.frame) * AWR1843.frame_period_s
    pelvis_m = pose.joints_m[np.clip(np.searchsorted(pose.time_s, at_s), 0, len(pose.time_s) - 1), joint("pelvis")]
    return float((np.hypot(points.x_m - pelvis_m[:, 0], points.y_m - pelvis_m[:, 1]) < NEAR_M).sum() / NUM_FRAMES)


def row_of(
    name: str, places: tuple[Place, Place], every: dict[int, dict[str, dict[str, float]]], *, refused: int
) -> dict[str, Any]:
    """One arrangement: means over the pairs of people (by seed), with 95 % intervals."""
    metrics: dict[str, Any] = {}
    runs = list(every.values())
    for metric in runs[0]:
        columns = {who: [scores[metric][who] for scores in runs] for who in runs[0][metric]}
        value, interval = _mean(columns.pop("superposition"))
        metrics[metric] = {
            "value": value, "interval_95": interval, **_meaning(metric),
            "baseline": {who: _mean(columns[who])[0] for who in BASELINES if who in columns} or None,
            "oracle": {who: _mean(columns[who])[0] for who in ORACLES if who in columns},
        }  # fmt: skip
    return {
        "dataset": {"name": name, "places_m": places, "room": "bundled sample", "sentences": list(SENTENCES)},
        "n": len(every),
        "seeds": list(every),
        "refused_for_lack_of_room": refused,
        "metrics": metrics,
    }


def _meaning(metric: str) -> dict[str, Any]:
    if metric in METRICS:
        return {"unit": METRICS[metric].unit, "definition": METRICS[metric].definition, "version": 1}
    own = {
        "second_dimmed_db": ("dB", "moving energy that the second adds to the first, over that of the second alone"),
        "points_of_second": ("points a frame", f"detections within {NEAR_M} m of the second's pelvis on the floor"),
    }
    unit, definition = own[metric]
    return {"unit": unit, "definition": definition, "version": 1}


def _mean(values: list[float]) -> tuple[float, list[float]]:
    all_values = np.array(values)
    draws = stream(0, "bootstrap").integers(len(values), size=(RESAMPLES, len(values)))
    low, high = np.percentile(all_values[draws].mean(axis=1), [2.5, 97.5])
    return round(float(all_values.mean()), 4), [round(float(low), 4), round(float(high), 4)]


def measure(run: StudyRun, picture: Path | None = None, seeds: tuple[int, ...] = SEEDS) -> Path:
    """All arrangements; one row each."""
    simulator = Simulator(sample_scene(), AWR1843, propagation=ALL_PATHS)
    rows, shown = [], []
    for name, places in ARRANGEMENTS.items():
        every: dict[int, dict[str, dict[str, float]]] = {}
        for seed in seeds:
            try:
                pair = make_pair(simulator, places, seed)
            except InputError:
                continue  # these two do not fit there: counted as refused
            if not every:
                shown.append((name, pair))
            every[seed] = scores_of(pair)
        rows.append(row_of(name, places, every, refused=len(seeds) - len(every)))
    if picture is not None:
        draw(shown, picture)
    rows = complete_rows(rows, unknown=UNKNOWN)
    return run.write("multi_person_scores", "superposition", config=CONFIG, rows=rows)


def draw(pairs: list[tuple[str, Pair]], path: Path) -> None:
    """Range-azimuth maps of the moving part: mutual occlusion, plain sum and their ratio; one row an arrangement."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power
    from mmweaver.viz.figure_data import Fan
    from mmweaver.viz.theme import POWER_MAP, STYLE, person_colour

    azimuth_rad = azimuth_axis_rad()
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(12.0, 3.1 * len(pairs)), dpi=100, facecolor="white", layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.subplots(len(pairs), 3, squeeze=False)
        for line, (name, pair) in zip(grid, pairs, strict=True):
            fan = Fan.over(pair.mutual.grid.range_m, azimuth_rad)
            maps = [
                range_azimuth_power(remove_static(cube), azimuth_rad).mean(axis=0) for cube in (pair.mutual, pair.plain)
            ]
            top = 10 * np.log10(maps[0].max())
            both = [10 * np.log10(power) - top for power in maps]
            for axes, values, title in zip(line, both, (name, "plain sum"), strict=False):
                power = axes.imshow(
                    fan.lay(values), origin="lower", cmap=POWER_MAP, vmin=-SPAN_DB, vmax=0.0, extent=fan.extent
                )
                axes.set_title(title)
            figure.colorbar(power, ax=line[1], shrink=0.8, label="dB of the peak")
            clipped = [np.maximum(values, -SPAN_DB) for values in both]
            image = line[2].imshow(
                fan.lay(clipped[1] - clipped[0]), origin="lower", cmap="coolwarm", vmin=-15, vmax=15, extent=fan.extent
            )
            line[2].set_title("plain sum over mutual occlusion")
            figure.colorbar(image, ax=line[2], shrink=0.8, label="dB")
            line[0].set_ylabel("ahead (m)")
            for axes in line:
                axes.set_xlabel("right (m)")
                for index, pose in enumerate(pair.poses):
                    x_m, y_m = pose.joints_m[:, joint("pelvis"), :2].mean(axis=0)
                    colour = person_colour(index, 2, on_white=axes is line[2])
                    axes.plot(x_m, y_m, "o", color=colour, fillstyle="none", markersize=9)
        figure.savefig(path)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--picture", type=Path, default=None)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run, options.picture)
