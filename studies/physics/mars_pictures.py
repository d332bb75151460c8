"""Recorded and simulated point clouds of MARS from the front, of `validate`, with the joints that drive the simulator.

python -m studies run mars_pictures --data shared/data/pointclouds/mars/subject1 --out docs/images

The settings are those of results/mars/simulator.json.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.records import PointCloud
from mmweaver.core.skeleton import BONES
from studies.manifest import StudyRun
from studies.physics.mars import Clouds, MarsVariant, Setup, detect, simulate
from studies.physics.mars_data import MarsStretch, read_mars
from studies.physics.mars_pieces import cut
from studies.study import Reads

SHOWN, FRAMES = 6, 5  # so many pieces, so many frames of each together
PIECE_FRAMES = 20
SHOWN_MPS = 1.5
EDGES_M = np.arange(-1.0, 1.05, 0.1)


def setup_of(result: Path) -> Setup:
    """The estimated parameters, from a result of mars."""
    held: dict[str, Any] = json.loads(result.read_text(encoding="utf-8"))["config"]["estimated_on_validate"]
    held["shift_m"] = tuple(held["shift_m"])
    return Setup(**held)


def draw(pieces: list[MarsStretch], real: Clouds, ours: Clouds, setup: Setup, path: Path) -> None:
    """One column a piece, the last of all heights; recorded above, simulated below."""
    from matplotlib.figure import Figure

    columns = len(pieces) + 1
    figure = Figure(figsize=(2.2 * columns, 6.2), layout="constrained", dpi=110)
    axes = figure.subplots(2, columns, sharey=True, squeeze=False)
    shown: Any = None
    for row, (title, clouds) in enumerate((("recorded", real), ("simulated", ours))):
        for column, (piece, frames) in enumerate(zip(pieces, clouds, strict=True)):
            axis, middle = axes[row, column], len(frames) // 2
            few = frames[max(middle - FRAMES // 2, 0) : middle + FRAMES // 2 + 1]
            _bones(axis, piece.joints_m[middle] + np.asarray(setup.shift_m))
            shown = axis.scatter(
                _joined(few, "x_m"), _joined(few, "z_m"), s=9, c=_joined(few, "radial_velocity_mps"), cmap="coolwarm",
                vmin=-SHOWN_MPS, vmax=SHOWN_MPS, linewidths=0.2, edgecolors="0.3",
            )  # fmt: skip
            axis.set(title=title, xlim=(-0.9, 0.9), ylim=(-1.05, 1.05), aspect="equal")
        heights = np.concatenate([cloud.z_m for frames in clouds for cloud in frames])
        axes[row, -1].hist(
            heights, EDGES_M, orientation="horizontal", weights=np.full(len(heights), 100 / max(len(heights), 1))
        )
        axes[row, -1].set(title=f"{title}, all frames", xlabel="% of points", xlim=(0, 20))
    for axis in axes[:, 0]:
        axis.set_ylabel("height over the radar, m")
    for axis in axes[1, :-1]:
        axis.set_xlabel("to the right, m")
    if shown is not None:
        figure.colorbar(shown, ax=axes, label="radial velocity, m/s (red: away)", shrink=0.7)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png")


def _bones(axis: Any, joints_m: np.ndarray) -> None:
    for one, other in BONES:
        axis.plot(*joints_m[[one, other]][:, [0, 2]].T, color="0.75", linewidth=1.5, zorder=0)


def _joined(clouds: tuple[PointCloud, ...], name: str) -> np.ndarray:
    return np.concatenate([getattr(cloud, name) for cloud in clouds])


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder of a MARS subject")
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    setup = setup_of(run.out / "mars" / "simulator.json")
    pieces = cut(read_mars(options.data, "validate"), PIECE_FRAMES, SHOWN)
    ours = detect(simulate(pieces, setup, MarsVariant()), pieces, setup, MarsVariant())
    real: Clouds = [piece.clouds for piece in pieces]
    draw(pieces, real, ours, setup, options.out / "mars.png")
