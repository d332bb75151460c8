"""Recorded and generated moving points of one window of each activity: range over time, coloured by velocity.

python -m studies run zero_shot_pictures --recordings shared/data/pointclouds/radhar --out docs/images
"""

import argparse
from pathlib import Path

from mmweaver.core.atomic_files import atomic_file
from mmweaver.recognition.point_recordings import PointRecording, is_moving
from studies.manifest import StudyRun
from studies.recognition.zero_shot_recipe import generate_window, radhar_recipe
from studies.recognition.zero_shot_training import radhar_recordings
from studies.study import Reads

SHOWN_MPS = 2.5
SECONDS = 4.0


def draw(
    real: dict[str, PointRecording], made: dict[str, PointRecording], path: Path, *, seconds: float = SECONDS,
    ranges_m: tuple[float, float] = (0.8, 3.0), wide: float = 3.0,
) -> None:  # fmt: skip
    """One column an activity, `wide` inches; above the recording, below the generated window."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(wide * len(real), 5.4), layout="constrained", dpi=110)
    axes = figure.subplots(2, len(real), sharex=True, sharey=True, squeeze=False)
    shown = None
    for column, label in enumerate(real):
        for row, (title, one) in enumerate((("real", real[label]), ("generated", made[label]))):
            cloud, axis = one.cloud, axes[row, column]
            range_m = cloud.range_m
            time_s = cloud.frame / one.frame_rate_hz
            still = ~is_moving(cloud)
            axis.scatter(time_s[still], range_m[still], s=1, color="0.8", linewidths=0)
            shown = axis.scatter(
                time_s[~still], range_m[~still], s=7, c=cloud.radial_velocity_mps[~still], cmap="coolwarm",
                vmin=-SHOWN_MPS, vmax=SHOWN_MPS, linewidths=0,
            )  # fmt: skip
            axis.set_title(f"{label}, {title}".replace("_", " "), fontsize=10 if wide > 2 else 8)
            axis.set_ylim(*ranges_m)
            axis.set_xlim(0.0, seconds)
    for axis in axes[1]:
        axis.set_xlabel("time, s")
    for axis in axes[:, 0]:
        axis.set_ylabel("range, m")
    if shown is not None:
        figure.colorbar(shown, ax=axes, label="radial velocity, m/s (red: away)", shrink=0.8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    parser.add_argument("--seed", type=int, default=0)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    from dataclasses import replace

    recipe = replace(radhar_recipe(), window_s=SECONDS)
    people = radhar_recordings(options.recordings)
    real = {}
    for label in recipe.activities:
        own = [one for one in people if one.label == label]
        real[label] = own[0].windows(SECONDS)[1]
    made = {label: generate_window(recipe, label, options.seed, 7) for label in recipe.activities}
    draw(real, made, options.out / "zero_shot.png")
