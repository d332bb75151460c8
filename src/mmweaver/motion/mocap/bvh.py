"""BVH files: from a hierarchy of offsets and the joint angles of every frame to joint positions.

Files vary in ways that break parsers: names with spaces, channels in any order, position channels on every joint,
Windows line ends, no newline at the end (docs/decisions/motion-files.md).
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.motion.mocap.clip import RawMotion

Array = np.ndarray
POSITIONS = {"Xposition": 0, "Yposition": 1, "Zposition": 2}
ROTATIONS = {"Xrotation": "X", "Yrotation": "Y", "Zrotation": "Z"}


@dataclass
class Node:
    """One joint of the hierarchy.

    Attributes:
        name: Name in the file.
        parent: Index of the parent, -1 for a root.
        offset: Offset from the parent in the file's unit, (3,).
        channels: Names of its channels in order.
        first_channel: Index of the first one within a frame.
    """

    name: str
    parent: int
    offset: Float[Array, "3"] = field(default_factory=lambda: np.zeros(3))
    channels: tuple[str, ...] = ()
    first_channel: int = 0


def read_bvh(path: Path) -> RawMotion:
    """Reads a BVH file by forward kinematics.

    Args:
        path: The file.

    Returns:
        All joints (frame, joint, 3) under the file's names and in its unit.

    Raises:
        InputError: If it is not a BVH file with motion, or damaged.
    """
    text = read_text(path, errors="replace").replace("{", "\n{\n").replace("}", "\n}\n").replace("\t", " ")
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if not lines or lines[0].upper() != "HIERARCHY":
        raise InputError(f"{path} is no BVH file: it does not begin with HIERARCHY")
    motion = next((k for k, line in enumerate(lines) if line.upper() == "MOTION"), None)
    if motion is None:
        raise InputError(f"{path} has a skeleton but no MOTION; export it with its animation")
    nodes = _hierarchy(lines[1:motion], path)
    fps, values = _frames(lines[motion + 1 :], sum(len(node.channels) for node in nodes), path)
    return RawMotion(
        names=tuple(node.name for node in nodes), positions=_positions(nodes, values), kind="BVH", fps=fps, up=None
    )


def _hierarchy(lines: list[str], path: Path) -> list[Node]:
    nodes: list[Node] = []
    open_nodes: list[int] = []
    channels = 0
    for line in lines:
        word, _, rest = line.partition(" ")
        word = word.upper()
        if word in ("ROOT", "JOINT"):
            if word == "ROOT" and nodes:
                raise InputError(f"{path} holds several skeletons; only one person can be read, export one at a time")
            nodes.append(Node(rest.strip(), open_nodes[-1] if open_nodes else -1))
        elif word == "END" and open_nodes:
            nodes.append(Node(f"{nodes[open_nodes[-1]].name}_end", open_nodes[-1]))
        elif word == "{" and nodes:
            open_nodes.append(len(nodes) - 1)
        elif word == "}" and open_nodes:
            open_nodes.pop()
        elif word == "OFFSET" and nodes:
            nodes[-1].offset = _numbers(rest.split(), path, line)
            if len(nodes[-1].offset) != 3:
                raise InputError(f"{path}: {line!r} is no offset of three numbers; the file is damaged")
        elif word == "CHANNELS" and nodes and not nodes[-1].channels:
            nodes[-1].channels = _channels(rest.split(), path, line)
            nodes[-1].first_channel = channels
            channels += len(nodes[-1].channels)
        else:
            raise InputError(f"{path}: {line[:60]!r} is not understood in a BVH hierarchy; the file is damaged")
    if not nodes or open_nodes:
        raise InputError(f"{path} has no complete skeleton: a bracket is not closed; the file is damaged")
    return nodes


def _channels(words: list[str], path: Path, line: str) -> tuple[str, ...]:
    names = tuple(word.capitalize() for word in words[1:])
    known = all(name in POSITIONS or name in ROTATIONS for name in names)
    if not words or not words[0].isdigit() or int(words[0]) != len(names) or not known or len(set(names)) < len(names):
        raise InputError(f"{path}: {line[:80]!r} names no channels that are known, or one twice; the file is damaged")
    return names


def _frames(lines: list[str], num_channels: int, path: Path) -> tuple[float | None, Float[Array, "frame channel"]]:
    """Frame rate (None where the file has none) and channel values (frame, channel)."""
    head = {line.partition(":")[0].strip().lower(): line.partition(":")[2].strip() for line in lines[:2]}
    try:
        count, step_s = int(head["frames"]), float(head["frame time"])
    except (KeyError, ValueError):
        raise InputError(f"{path}: after MOTION, Frames: and Frame Time: are missing; the file is damaged") from None
    if count < 1:
        raise InputError(f"{path} has no frames; export it with its animation")
    values = _numbers(" ".join(lines[2:]).split(), path, "the motion")
    if len(values) != count * num_channels:
        raise InputError(
            f"{path} holds {len(values)} numbers, {count} frames of {num_channels} channels need"
            f" {count * num_channels}; it was cut short or changed"
        )
    return (1 / step_s if step_s > 0 else None), values.reshape(count, num_channels)


def _numbers(words: list[str], path: Path, where: str) -> Float[Array, " n"]:
    try:
        return np.array(words, dtype=float)
    except ValueError:
        raise InputError(f"{path}: {where[:60]} has something that is no number; the file is damaged") from None


def _positions(nodes: list[Node], values: Float[Array, "frame channel"]) -> Float[Array, "frame joint 3"]:
    """Forward kinematics; rotations are intrinsic, in the order of the channels."""
    from scipy.spatial.transform import Rotation

    count = len(values)
    positions = np.zeros((count, len(nodes), 3))
    turned: list[Float[Array, "frame 3 3"]] = []
    for k, node in enumerate(nodes):
        own = values[:, node.first_channel : node.first_channel + len(node.channels)]
        axes = "".join(ROTATIONS[name] for name in node.channels if name in ROTATIONS)
        angles = own[:, [i for i, name in enumerate(node.channels) if name in ROTATIONS]]
        missing = np.asarray(~np.isfinite(angles).all(axis=1))
        matrix = np.tile(np.eye(3), (count, 1, 1))
        if axes:
            matrix = Rotation.from_euler(axes, np.where(missing[:, None], 0.0, angles), degrees=True).as_matrix()
            matrix = np.array(matrix)
            matrix[missing] = np.nan
        shift = _shift(node, own)
        if node.parent < 0:
            positions[:, k], _ = shift, turned.append(matrix)
            continue
        above = turned[node.parent]
        positions[:, k] = positions[:, node.parent] + np.einsum("fij,fj->fi", above, shift)
        turned.append(np.einsum("fij,fjk->fik", above, matrix))
    return positions


def _shift(node: Node, own: Float[Array, "frame channel"]) -> Float[Array, "frame 3"]:
    """Offset of a joint from its parent. Position channels of a root add to its offset; of another joint they
    replace it (exporters that write six channels everywhere) unless they are short compared with it."""
    shift = np.tile(node.offset, (len(own), 1))
    moved = {POSITIONS[name]: own[:, i] for i, name in enumerate(node.channels) if name in POSITIONS}
    if not moved:
        return shift
    given = np.zeros_like(shift)
    for axis, values in moved.items():
        given[:, axis] = values
    if node.parent < 0:
        return shift + given
    long = np.linalg.norm(given[np.isfinite(given).all(axis=1)], axis=1)
    replaces = bool(len(long)) and float(np.median(long)) > 0.5 * float(np.linalg.norm(node.offset))
    return given if replaces else shift + given
