"""C3D files, written here byte by byte from the format's user guide, with markers put on a body of known joints."""

import struct
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.motion.mocap.c3d import read_c3d
from mmweaver.motion.mocap.read_motion import to_clip
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward

FRAMES = 20


def body() -> dict[str, np.ndarray]:
    """Joints of a standing body that walks ahead, (frame, 3) in millimetres, z up, x right, y ahead."""
    joints = forward(np.zeros((FRAMES, 22, 3)), np.zeros((FRAMES, 3)), MEAN_OFFSET_M)
    joints = 1000 * np.stack([-joints[..., 0], joints[..., 2], joints[..., 1] + 1.0], axis=-1)
    joints[..., 1] += 20 * np.arange(FRAMES)[:, None]
    return dict(zip(JOINT_NAMES, joints.transpose(1, 0, 2), strict=True))


def markers() -> dict[str, np.ndarray]:
    """Plug-in Gait's markers on that body."""
    at, found = body(), {}
    for side, letter in (("left", "L"), ("right", "R")):
        out = -1.0 if side == "left" else 1.0
        hip = at[f"{side}_hip"]
        middle = (at["left_hip"] + at["right_hip"]) / 2
        found[f"{letter}ASI"] = middle + np.array([130 * out, 49, 78])
        found[f"{letter}PSI"] = middle + np.array([50 * out, -120, 78])
        assert np.abs(hip - middle).max() < 100
        for name, marker in (("knee", "KNE"), ("ankle", "ANK"), ("elbow", "ELB"), ("shoulder", "SHO")):
            found[letter + marker] = at[f"{side}_{name}"] + [20 * out, 0, 0]
        found[f"{letter}TOE"] = at[f"{side}_foot"]
        for marker, ahead in (("WRA", 20), ("WRB", -20)):
            found[letter + marker] = at[f"{side}_wrist"] + [0, ahead, 0]
        for marker, ahead in (("FHD", 80), ("BHD", -80)):
            found[letter + marker] = at["head"] + [60 * out, ahead, 20]
    found["C7"], found["CLAV"] = at["neck"] + [0, -60, 0], at["neck"] + [0, 60, 0]
    return found


def parameter(group: int, name: str, kind: int, sizes: list[int], data: bytes) -> bytes:
    rest = struct.pack("<bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
    return struct.pack("<bb", len(name), group) + name.encode() + struct.pack("<h", 2 + len(rest)) + rest


def write_c3d(path: Path, tracks: dict[str, np.ndarray], *, scale: float = -1.0, gap: str = "") -> None:
    labels = "".join(f"Anna:{name}".ljust(16) for name in tracks).encode()
    body = b"\1\0\0\x54" + struct.pack("<bb", 5, -1) + b"POINT" + struct.pack("<h", 3) + b"\0"
    body += parameter(1, "USED", 2, [], struct.pack("<h", len(tracks)))
    body += parameter(1, "SCALE", 4, [], struct.pack("<f", scale))
    body += parameter(1, "RATE", 4, [], struct.pack("<f", 100.0))
    body += parameter(1, "DATA_START", 2, [], struct.pack("<h", 8))
    body += parameter(1, "UNITS", -1, [2], b"mm")
    body += parameter(1, "LABELS", -1, [16, len(tracks)], labels) + b"\0\0"
    body = body[:2] + bytes([6]) + body[3:]
    rows = np.zeros((FRAMES, len(tracks), 4))
    rows[..., :3] = np.stack(list(tracks.values()), axis=1) / abs(scale)
    if gap:
        rows[5:8, list(tracks).index(gap), 3] = -1
    kind = "<f4" if scale < 0 else "<i2"
    head = struct.pack("<BBHHHHHfHHf", 2, 0x50, len(tracks), 0, 1, FRAMES, 0, scale, 8, 0, 100.0)
    data = rows.astype(kind).tobytes()
    path.write_bytes(head.ljust(512, b"\0") + body.ljust(6 * 512, b"\0") + data)


@pytest.mark.parametrize("scale", [-1.0, 0.1])
def test_joints_lie_where_the_markers_were_put(tmp_path: Path, scale: float):
    write_c3d(tmp_path / "walk.c3d", markers(), scale=scale)
    raw = read_c3d(tmp_path / "walk.c3d")
    clip = to_clip(raw, "walk.c3d")
    assert clip.fps == 100
    truth = np.stack(list(body().values()), axis=1) / 1000
    error_m = np.linalg.norm(clip.joints_m - truth[-len(clip.joints_m) :], axis=2).max(axis=0)
    of = dict(zip(JOINT_NAMES, error_m, strict=True))
    for name in ("knee", "ankle", "foot", "shoulder", "elbow", "wrist"):
        assert max(of[f"left_{name}"], of[f"right_{name}"]) < 0.025, name
    assert max(of["left_hip"], of["right_hip"]) < 0.05
    assert of["head"] < 0.03


def test_a_gap_is_filled_and_reported(tmp_path: Path):
    write_c3d(tmp_path / "walk.c3d", markers(), gap="LKNE")
    raw = read_c3d(tmp_path / "walk.c3d")
    assert np.isnan(raw.positions[5:8, raw.names.index("left_knee")]).all()
    clip = to_clip(raw, "walk.c3d")
    assert np.isfinite(clip.joints_m).all()


def test_other_markers_and_damage_are_one_line(tmp_path: Path):
    write_c3d(tmp_path / "walk.c3d", {"M1": np.zeros((FRAMES, 3)), "M2": np.ones((FRAMES, 3))})
    with pytest.raises(InputError, match="Plug-in Gait"):
        read_c3d(tmp_path / "walk.c3d")
    data = (tmp_path / "walk.c3d").read_bytes()
    for cut in (100, 600, 1030):
        (tmp_path / "cut.c3d").write_bytes(data[:cut])
        with pytest.raises(InputError):
            read_c3d(tmp_path / "cut.c3d")
