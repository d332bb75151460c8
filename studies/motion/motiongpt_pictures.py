"""Skeleton strips of the motions that a MotionGPT generates for twelve sentences.

python -m studies run motiongpt_pictures --model weights/motiongpt_small.safetensors --out strips.png
"""

import argparse
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.skeleton import BONES, JOINT_NAMES
from mmweaver.motion.mocap.humanml3d import FPS
from mmweaver.motion.motiongpt.motiongpt import MotionGPT
from studies.manifest import StudyRun
from studies.motion.motiongpt_data import ACTIVITIES, FRAMES, sentence_of
from studies.study import Reads

POSES, APART_M, VIEW_RAD = 10, 0.75, 0.6
COLOURS = {"left": "#1f77b4", "right": "#d62728", "middle": "#444444"}


def draw_strips(clips: dict[str, Float[np.ndarray, "frame 22 3"]], path: Path) -> None:
    """One row a clip (metres, z up), poses evenly in time from left to right, seen from the front and the side."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 1.45 * len(clips)), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, (title, joints) in zip(figure.subplots(len(clips), 1, squeeze=False)[:, 0], clips.items(), strict=True):
        floor = joints[..., 2].min()
        for k, frame in enumerate(np.linspace(0, len(joints) - 1, POSES).astype(int)):
            pose = joints[frame]
            ground = pose[:, :2] - pose[0, :2]
            across = ground[:, 0] * np.cos(VIEW_RAD) + ground[:, 1] * np.sin(VIEW_RAD)
            flat = np.stack([across + k * APART_M, pose[:, 2] - floor], axis=1)
            lines = [flat[list(bone)] for bone in BONES]
            axes.add_collection(
                LineCollection(lines, colors=[COLOURS[_side(bone[1])] for bone in BONES], linewidths=1.5)
            )
        axes.plot([-0.6, POSES * APART_M], [0, 0], color="#bbbbbb", linewidth=0.8)
        axes.set_xlim(-0.6, POSES * APART_M)
        axes.set_ylim(-0.05, 2.2)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(title, fontsize=8, loc="left", pad=1)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, dpi=80, format="png", bbox_inches="tight", pad_inches=0.05)


def _side(joint_index: int) -> str:
    side = JOINT_NAMES[joint_index].split("_")[0]
    return side if side in COLOURS else "middle"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--model", type=Path, action=Reads, required=True, help="a MotionGPT checkpoint")
    parser.add_argument("--out", type=Path, required=True, help="picture to write")
    parser.add_argument("--seed", type=int, default=9000, help="of the motions and their sentences")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    model = MotionGPT.load(options.model)
    clips = {}
    for activity in ACTIVITIES:
        sentence = sentence_of(activity, options.seed, held_out=False)
        clips[sentence] = model.generate(sentence, seconds=FRAMES / FPS, seed=options.seed).joints_m
    draw_strips(clips, options.out)
