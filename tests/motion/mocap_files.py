"""Motion files made in the test, of a motion that is known: our library's walk under other people's conventions."""

from functools import cache
from pathlib import Path

import numpy as np

from mmweaver.core.skeleton import JOINT_NAMES, PARENTS
from mmweaver.motion.animation.root_path import resample
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from rooms import FLOOR_Z_M, WINDOW_M, room

Array = np.ndarray


@cache
def walk(fps: float = 60.0, seconds: float = 2.0, text: str = "a person walks to the left") -> Array:
    """Joints (frame, 22, 3) of a walk, z up, floor at 0."""
    pose = compose(plan_motion(text, seconds), room(), seed=2, range_window_m=WINDOW_M, height_m=1.75).pose
    joints = resample(pose, np.arange(round(seconds * fps)) / fps).joints_m
    return joints - np.array([0.0, 0.0, FLOOR_Z_M])


def y_up(joints: Array) -> Array:
    return np.stack([joints[..., 0], joints[..., 2], -joints[..., 1]], axis=-1)


def write_bvh(
    path: Path,
    joints: Array,
    *,
    names: tuple[str, ...] = JOINT_NAMES,
    fps: float = 60.0,
    order: str = "ZXY",
    end: str = "\n",
    last_end: bool = True,
) -> None:
    """A BVH of joints that are free to change their place: six channels everywhere, offsets of the first frame.

    Each joint is turned as well, by an angle of its own, so that the order of channels and rotations counts.
    """
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(0)
    count = len(joints)
    swing = np.cumsum(rng.normal(0, 2.0, (count, 22, 3)), axis=0)
    children = {k: [c for c, parent in enumerate(PARENTS) if parent == k] for k in range(22)}
    lines: list[str] = ["HIERARCHY"]
    columns: list[Array] = []

    def write(k: int, above: Array, depth: int) -> None:
        parent = PARENTS[k]
        shift = joints[:, k] - (joints[:, parent] if parent >= 0 else 0)
        local = np.einsum("fji,fj->fi", above, shift)
        matrix = np.asarray(Rotation.from_euler(order, swing[:, k], degrees=True).as_matrix())
        tab = "  " * depth
        offset = np.zeros(3) if parent < 0 else local[0]
        lines.append(f"{tab}{'ROOT' if parent < 0 else 'JOINT'} {names[k]}")
        lines.append(tab + "{")
        lines.append(f"{tab}  OFFSET " + " ".join(f"{v:.9f}" for v in offset))
        channels = "Xposition Yposition Zposition " + " ".join(f"{axis}rotation" for axis in order)
        lines.append(f"{tab}  CHANNELS 6 {channels}")
        columns.append(np.concatenate([local, swing[:, k]], axis=1))
        for child in children[k]:
            write(child, np.einsum("fij,fjk->fik", above, matrix), depth + 1)
        if not children[k]:
            lines.extend([f"{tab}  End Site", tab + "  {", f"{tab}    OFFSET 0 0 0.1", tab + "  }"])
        lines.append(tab + "}")

    write(0, np.tile(np.eye(3), (count, 1, 1)), 0)
    lines += ["MOTION", f"Frames: {count}", f"Frame Time: {1 / fps:.9f}"]
    lines += [" ".join(f"{value:.9f}" for value in row) for row in np.concatenate(columns, axis=1)]
    path.write_text(end.join(lines) + (end if last_end else ""), newline="")
