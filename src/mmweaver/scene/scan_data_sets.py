"""Folders of data sets of rooms with depth: 7-Scenes, Replica, SUN RGB-D, Redwood, ICL-NUIM.

Each has its own unit of depth and its own cameras; facts: table in docs/photos.md.
"""

import re
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_pictures import open_picture
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.scene.depth_scale import UNITS, is_rotated, rotated_by_three
from mmweaver.scene.photo.capture_photo import Pose
from mmweaver.scene.photo.picture_files import read_depth, read_rgb
from mmweaver.scene.scan_format import ScanFormat, ScanFrame, checked_pose, number_table

MILLIMETRE = UNITS["mm"][0]
SEVEN_SCENES = (585.0, 585.0, 320.0, 240.0)  # of the depth camera; colours of the Kinect are not aligned with it
PRIMESENSE = (525.0, 525.0, 319.5, 239.5)  # Redwood's and Open3D's default camera
ICL_NUIM = (481.2, 480.0, 319.5, 239.5)


def last_number(picture: Path) -> float:
    """Number of a frame in a file's name: 12 of frame-000012.color.png, 1868.25 of 1868.25.png; -1 without one."""
    found = re.findall(r"\d+(?:\.\d+)?(?=\D*$)", picture.stem)
    return float(found[-1]) if found else -1.0


def _seven_scenes(folder: Path, colour: Path) -> ScanFrame:
    """frame-000000.color.png, .depth.png in millimetres (65535: none), .pose.txt."""
    depth, rgb = _sibling(colour, ".color", ".depth"), read_rgb(colour)[0]
    return ScanFrame(
        rgb=rgb,
        depth_m=read_depth(depth, MILLIMETRE)[0],
        lens=np.array(SEVEN_SCENES) * rgb.shape[1] / 640,
        files={"rgb": colour, "depth": depth},
        notes=("7-Scenes: the camera is the published one of the depth; colours are up to some centimetres off.",),
    )


def _seven_scenes_pose(folder: Path, colour: Path) -> Pose | None:
    file = colour.with_name(colour.name.replace(".color.png", ".pose.txt"))
    return checked_pose(number_table(file)) if file.is_file() else None


def _replica(folder: Path, colour: Path) -> ScanFrame:
    """Renderings of NICE-SLAM: results/frame000000.jpg, results/depth000000.png, traj.txt; cam_params.json above."""
    depth = (colour.parent / colour.name.replace("frame", "depth")).with_suffix(".png")
    file = next((one for one in (folder / "cam_params.json", folder.parent / "cam_params.json") if one.is_file()), None)
    rgb = read_rgb(colour)[0]
    camera = {} if file is None else read_json(file).get("camera", {})
    width = rgb.shape[1]
    try:
        lens = [float(camera.get(key, width / 2)) for key in ("fx", "fy")]
        lens += [float(camera.get("cx", (width - 1) / 2)), float(camera.get("cy", (rgb.shape[0] - 1) / 2))]
        unit_m = 1 / float(camera.get("scale", 6553.5))
    except (TypeError, ValueError, ZeroDivisionError, AttributeError):
        raise InputError(f"{file} is no cam_params.json of Replica: camera with fx, fy, cx, cy and scale") from None
    return ScanFrame(
        rgb=rgb,
        depth_m=read_depth(depth, unit_m)[0],
        lens=lens,
        files={"rgb": colour, "depth": depth},
        notes=()
        if file is not None
        else ("No cam_params.json: 6553.5 counts a metre and Replica's camera were taken.",),
    )


def _replica_pose(folder: Path, colour: Path) -> Pose | None:
    file, number = folder / "traj.txt", int(last_number(colour))
    rows = number_table(file) if file.is_file() else np.zeros((0, 16))
    return checked_pose(rows[number].reshape(4, 4)) if rows.shape[1] == 16 and 0 <= number < len(rows) else None


def _sun_rgbd(folder: Path, colour: Path) -> ScanFrame:
    """image/*.jpg, depth_bfx or depth/*.png with bits rotated by three, intrinsics.txt (3 x 3)."""
    depth = next(one for place in ("depth_bfx", "depth") for one in sorted((folder / place).glob("*.png")))
    picture = open_picture(depth)
    counts = np.array(picture.image).astype(np.uint16)
    if is_rotated(counts) or counts.max() > 10_000:  # 8 m and more set the lowest bits
        counts = rotated_by_three(counts)
    matrix = number_table(folder / "intrinsics.txt").reshape(-1)
    if len(matrix) < 9:
        raise InputError(f"{folder / 'intrinsics.txt'} holds {len(matrix)} numbers; it must be 3 x 3")
    return ScanFrame(
        rgb=read_rgb(colour)[0],
        depth_m=np.where(counts > 0, counts * MILLIMETRE, np.nan),
        lens=matrix[[0, 4, 2, 5]],
        files={"rgb": colour, "depth": depth},
    )


def _redwood(folder: Path, colour: Path) -> ScanFrame:
    """rgb, color or image/ and depth/ with pictures in the same order; millimetres; trajectory.log of Open3D."""
    depth = _same_number(folder / "depth", colour)
    rgb = read_rgb(colour)[0]
    return ScanFrame(
        rgb=rgb,
        depth_m=read_depth(depth, MILLIMETRE)[0],
        lens=np.array(PRIMESENSE) * rgb.shape[1] / 640,
        files={"rgb": colour, "depth": depth},
        notes=("The camera is the default one of Redwood and Open3D.",),
    )


def _redwood_pose(folder: Path, colour: Path) -> Pose | None:
    file = next((one for name in ("trajectory.log", "odometry.log") for one in folder.glob(name)), None)
    if file is None:
        return None
    rows = number_table_of_log(file)
    numbers = sorted(int(last_number(one)) for one in colour.parent.iterdir())
    at = numbers.index(int(last_number(colour)))
    return checked_pose(rows[at]) if at < len(rows) else None


def number_table_of_log(path: Path) -> np.ndarray:
    """Poses (frame, 4, 4) of a .log of Open3D: a line of three integers, then four rows per pose."""
    from mmweaver.core.safe_files.safe_text import read_text

    rows = [line.split() for line in read_text(path).splitlines() if line.strip()]
    try:
        return np.array([row for row in rows if len(row) == 4], float).reshape(-1, 4, 4)
    except ValueError:
        raise InputError(f"{path} is no trajectory of Open3D; export it again") from None


def _icl_nuim(folder: Path, colour: Path) -> ScanFrame:
    """rgb/0.png, depth/0.png with 5000 counts a metre, associations.txt."""
    depth = folder / "depth" / colour.name
    rgb = read_rgb(colour)[0]
    return ScanFrame(
        rgb=rgb,
        depth_m=read_depth(depth, UNITS["tum"][0])[0],
        lens=np.array(ICL_NUIM) * rgb.shape[1] / 640,
        files={"rgb": colour, "depth": depth},
        notes=("The camera is the published one of ICL-NUIM.",),
    )


def _no_pose(folder: Path, colour: Path) -> Pose | None:
    return None


def _sibling(picture: Path, own: str, other: str) -> Path:
    found = picture.with_name(picture.name.replace(own, other))
    if not found.is_file():
        raise InputError(f"{picture.parent} holds {picture.name}, but not {found.name}")
    return found


def _same_number(folder: Path, colour: Path) -> Path:
    """The depth picture with the number of a colour picture."""
    number = re.search(r"\d+", colour.stem)
    found = (
        []
        if number is None
        else [one for one in folder.glob("*.png") if re.match(rf"\D*0*{int(number[0])}\D", one.name)]
    )
    if not found:
        raise InputError(f"{folder} holds no depth for {colour.name}")
    return sorted(found)[0]


DATA_SETS = {
    "7-Scenes": ScanFormat(
        markers=("frame-*.color.png", "frame-*.depth.png"),
        pictures=("frame-*.color.png",),
        read=_seven_scenes,
        pose=_seven_scenes_pose,
    ),
    "Replica": ScanFormat(
        markers=("results/frame*", "results/depth*"),
        pictures=("results/frame*.jpg", "results/frame*.png"),
        read=_replica,
        pose=_replica_pose,
    ),
    "SUN RGB-D": ScanFormat(
        markers=("image/*.jpg", "depth*/*.png", "intrinsics.txt"),
        pictures=("image/*.jpg",),
        read=_sun_rgbd,
        pose=_no_pose,
    ),
    "ICL-NUIM": ScanFormat(
        markers=("rgb/[0-9].png", "depth/[0-9].png"),
        pictures=("rgb/*.png",),
        read=_icl_nuim,
        pose=_no_pose,
    ),
    "Redwood": ScanFormat(
        markers=("depth/0*.png",),
        pictures=("rgb/*.jpg", "rgb/*.png", "color/*.jpg", "color/*.png", "image/*.jpg", "image/*.png"),
        read=_redwood,
        pose=_redwood_pose,
    ),
}
