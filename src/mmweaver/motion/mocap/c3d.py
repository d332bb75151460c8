"""C3D: markers of optical motion capture, from Vicon, Qualisys, OptiTrack and others; joints are estimated from them.

A header, parameters in groups (POINT: LABELS, UNITS, RATE, SCALE), then x, y, z and a residual per marker and frame, as
16-bit integers times SCALE, or as float32 where SCALE is negative. A negative residual marks a gap.
Joints are means of markers around them (Plug-in Gait, Helen Hayes); the centres of the hips follow from the pelvis.

Reference: C3D.org, The C3D File Format User Guide; Bell et al., J. Biomechanics 23, 1990 (hip joint centre).
"""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes
from mmweaver.motion.mocap.clip import RawMotion

BLOCK, INTEL = 512, 84
MAX_BYTES = 1000 * MEGABYTE
UNITS_M = {"mm": 0.001, "cm": 0.01, "m": 1.0, "inch": 0.0254, "in": 0.0254}
# markers around each joint, alternatives separated by "|": the first of which all are there is taken
SIDED = {
    "front": "{s}ASI | {s}ASIS",
    "knee": "{s}KNE {s}KNM | {s}KNE {s}MKN | {s}KNE",
    "ankle": "{s}ANK {s}MED | {s}ANK {s}MMA | {s}ANK",
    "foot": "{s}TOE",
    "shoulder": "{s}SHO",
    "elbow": "{s}ELB {s}ELBM | {s}ELB",
    "wrist": "{s}WRA {s}WRB | {s}WR | {s}WRA",
}
MARKERS = {
    "sacrum": "LPSI RPSI | SACR",
    "head": "LFHD RFHD LBHD RBHD | LFHD RFHD | HEAD",
    "neck": "C7 CLAV | C7",
    **{f"{side}_{name}": sets.format(s=side[0].upper()) for side in ("left", "right") for name, sets in SIDED.items()},
}
# hip centre from the middle of the front of the pelvis, as a share of the distance of its two markers (Bell)
HIP_ASIDE, HIP_BEHIND, HIP_BELOW = 0.36, 0.19, 0.30


@dataclass(frozen=True, kw_only=True)
class _Parameter:
    """Values of a parameter: numbers, or texts."""

    numbers: tuple[float, ...] = ()
    texts: tuple[str, ...] = ()


def read_c3d(path: Path) -> RawMotion:
    """Reads the markers of a C3D file and estimates joints from them.

    Args:
        path: The file.

    Returns:
        Joints in metres under our names, nan where all markers of a joint are missing.

    Raises:
        InputError: If the file is damaged, or the markers are of no known set.
    """
    data = read_bytes(path, max_bytes=MAX_BYTES)
    try:
        labels, points, rate, unit = _markers(data, path)
    except (struct.error, IndexError, ValueError, KeyError, UnicodeDecodeError) as error:
        raise InputError(
            f"{path} is no C3D file that can be read, or it is damaged ({error}); export it again"
        ) from None
    names, joints = _joints(dict(zip(labels, points.transpose(1, 0, 2), strict=False)), path)
    return RawMotion(
        names=names,
        positions=joints,
        kind="C3D",
        fps=rate,
        unit_m=UNITS_M.get(unit.lower()),
        notes=("joints were estimated from markers on the skin",),
    )


def _markers(data: bytes, path: Path) -> tuple[list[str], np.ndarray, float, str]:
    """Labels, places (frame, marker, 3) in the file's unit with nan in gaps, frames per second and unit."""
    if len(data) < 2 * BLOCK or data[1] != 0x50:
        raise InputError(f"{path} is no C3D file: its second byte is not 50 hex; export it again")
    start = (data[0] - 1) * BLOCK
    if data[start + 3] != INTEL:
        raise InputError(f"{path} was written for a DEC or MIPS processor; export it for Intel")
    found = _parameters(data, start)
    held = {name: found[f"POINT:{name}"] for name in ("USED", "SCALE", "RATE", "DATA_START")}
    used, scale = int(held["USED"].numbers[0]) & 0xFFFF, held["SCALE"].numbers[0]
    first, last = struct.unpack_from("<HH", data, 6)
    rate = struct.unpack_from("<f", data, 20)[0] or held["RATE"].numbers[0]
    analog = struct.unpack_from("<H", data, 4)[0]
    kind = np.dtype("<f4" if scale < 0 else "<i2")
    place = (int(held["DATA_START"].numbers[0]) - 1) * BLOCK
    row = 4 * used + analog
    count = min(last - first + 1, (len(data) - place) // (row * kind.itemsize))
    if used == 0 or count < 1:
        raise InputError(f"{path} holds {used} markers in {max(count, 0)} frames; export the trajectories, too")
    values = np.frombuffer(data, kind, count * row, place).reshape(count, row)[:, : 4 * used].astype(float)
    values = values.reshape(count, used, 4)
    points = values[..., :3] * (1.0 if scale < 0 else scale)
    points[values[..., 3] < 0] = np.nan
    labels = [text for key in ("LABELS", "LABELS2", "LABELS3") if f"POINT:{key}" in found
              for text in found[f"POINT:{key}"].texts]  # fmt: skip
    unit = found["POINT:UNITS"].texts[0] if "POINT:UNITS" in found else "mm"
    return labels[:used], points, float(rate), unit.strip()


def _parameters(data: bytes, start: int) -> dict[str, _Parameter]:
    """Parameters by "GROUP:NAME"."""
    groups: dict[int, str] = {}
    found: list[tuple[int, str, _Parameter]] = []
    at = start + 4
    while True:
        length, number = struct.unpack_from("<bb", data, at)
        if length == 0:
            break
        name_end = at + 2 + abs(length)
        name = data[at + 2 : name_end].decode("latin-1").upper()
        step = struct.unpack_from("<h", data, name_end)[0]
        if number < 0:
            groups[-number] = name
        elif number > 0:
            found.append((number, name, _values(data, name_end + 2)))
        if step <= 0:
            break
        at = name_end + step
    return {f"{groups.get(number, '')}:{name}": value for number, name, value in found}


def _values(data: bytes, at: int) -> _Parameter:
    kind, dimensions = struct.unpack_from("<bB", data, at)
    sizes = list(data[at + 2 : at + 2 + dimensions])
    at += 2 + dimensions
    count = int(np.prod(sizes)) if sizes else 1
    if kind == -1:
        width = sizes[0] if sizes else 1
        text = data[at : at + count].decode("latin-1")
        return _Parameter(texts=tuple(text[begin : begin + width].strip() for begin in range(0, count, max(width, 1))))
    number = {1: "u1", 2: "<i2", 4: "<f4"}[kind]
    return _Parameter(numbers=tuple(np.frombuffer(data, number, count, at).astype(float).tolist()))


def _joints(markers: dict[str, np.ndarray], path: Path) -> tuple[tuple[str, ...], np.ndarray]:
    """Our joints that the markers determine: names, and places (frame, joint, 3)."""
    held = {name.split(":")[-1].upper(): place for name, place in markers.items()}
    found: dict[str, np.ndarray] = {}
    for joint, sets in MARKERS.items():
        chosen = next((one.split() for one in sets.split("|") if set(one.split()) <= set(held)), None)
        if chosen is not None:
            found[joint] = np.mean([held[name] for name in chosen], axis=0)
    if {"left_front", "right_front", "sacrum"} <= set(found):
        left, right, back = (found[name] for name in ("left_front", "right_front", "sacrum"))
        middle, across = (left + right) / 2, left - right
        width = np.linalg.norm(across, axis=1, keepdims=True)
        aside = across / width
        ahead = (middle - back) - ((middle - back) * aside).sum(axis=1, keepdims=True) * aside
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        below = np.cross(aside, ahead)
        knees = (found["left_knee"] + found["right_knee"]) / 2 - middle if "left_knee" in found else below
        below *= np.sign((below * knees).sum(axis=1, keepdims=True))
        centre = middle - HIP_BEHIND * width * ahead + HIP_BELOW * width * below
        found |= {"left_hip": centre + HIP_ASIDE * across, "right_hip": centre - HIP_ASIDE * across}
    names = tuple(name for name in found if name not in ("left_front", "right_front", "sacrum"))
    if not {"left_hip", "left_knee", "left_ankle", "left_shoulder", "head"} <= set(names):
        few = ", ".join(list(held)[:12])
        raise InputError(
            f"{path} has markers {few}{', ...' if len(held) > 12 else ''}; Plug-in Gait's (LASI, LKNE, LANK, LSHO,"
            " LFHD, ...) are known"
        )
    return names, np.stack([found[name] for name in names], axis=1)
