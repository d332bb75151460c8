"""One photo with depth of a scan, or several joined by its poses, from the folders of apps and data sets.

The depth of phones is coarse; colours are resampled to it as in `read_photo`, and depth of the lowest confidence is
dropped. Phones store pictures in the sensor's orientation; the recorded pose tells which side is up, and the photo is
rotated upright. Facts of the formats: table in docs/photos.md.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import resized, rotated_clockwise
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.shapes import DepthPixels
from mmweaver.scene.photo.capture_photo import CapturedPhoto, Pose, PosedPhoto
from mmweaver.scene.photo.depth_grid import fill_scattered_holes
from mmweaver.scene.photo.lzfse import read_lzfse
from mmweaver.scene.photo.picture_files import read_depth, read_rgb, read_video_frame
from mmweaver.scene.read_photo import to_common_size
from mmweaver.scene.scan_data_sets import DATA_SETS, last_number
from mmweaver.scene.scan_format import ScanFormat, ScanFrame, checked_pose, number_table

MILLIMETRE, TUM_UNIT_M = 0.001, 0.0002
MAX_DOUBTFUL = 0.7  # share of the depth; if more has the lowest confidence, all of it is kept
TUM_APART_S, TUM_POSE_APART_S = 0.03, 0.05  # maximum time between colour and depth, or pose
# fx, fy, cx, cy of 640 x 480 (Sturm et al., IROS 2012, and the data set's page); by default those of ROS
TUM_CAMERAS = {
    "freiburg1": (517.3, 516.5, 318.6, 255.3),
    "freiburg2": (520.9, 521.0, 325.1, 249.7),
    "freiburg3": (535.4, 539.2, 320.1, 247.6),
    "": (525.0, 525.0, 319.5, 239.5),
}
Y_UP_CAMERA = np.diag([1.0, -1.0, -1.0, 1.0])  # from x right, y down, z forward to ARKit's x right, y up, z backward
DEGREES_A_METRE = 30.0  # rotation that reveals as much of the room as a metre of translation
ENOUGH = 1.0  # metres, or the equivalent rotation: nearer frames are redundant


def scan_kind(folder: Path) -> str | None:
    """Recognizes the app or data set that wrote a folder.

    Args:
        folder: Any path.

    Returns:
        Name of the format, a key of FORMATS; None if unknown.

    >>> scan_kind(Path("no_such_folder")) is None
    True
    """
    if not folder.is_dir():
        return None
    return next((kind for kind, one in FORMATS.items() if all(any(folder.glob(name)) for name in one.markers)), None)


def scan_pose(folder: Path, kind: str, frame: Path) -> Pose | None:
    """The pose of a frame in its stored orientation.

    Args:
        folder: Folder of the scan.
        kind: Format, a key of FORMATS.
        frame: Picture that numbers the frame.

    Returns:
        Transform (4, 4) from camera (x right, y down, z forward) to world, metres; None if the scan has none.
    """
    return FORMATS[kind].pose(folder, frame)


def refuse_unread(place: Path) -> None:
    """Rejects formats of scanning apps that need conversion first.

    Args:
        place: Path given by the user.

    Raises:
        InputError: If the format is not supported, with the conversion to use.
    """
    name = place.name
    if place.suffix.lower() == ".r3d":
        raise InputError(f"{place} is Record3D's archive; unpack it (unzip {name} -d scan) and give the folder")
    if place.is_dir() and any(place.glob("**/depth/*.exr")):
        raise InputError(
            f"{place} is Record3D's export as EXR and pictures, and OpenEXR is not read; export the .r3d and unpack it"
        )
    if place.is_file() and place.suffix.lower() != ".json":
        raise InputError(f"{place} is no recording of a room that is read; give the folder of a scan or a ROS bag")


def read_scan_photo(folder: Path, index: int = 0, further: Sequence[int] | str = ()) -> CapturedPhoto:
    """Reads one photo of a scan, and further ones that show more of the room.

    Args:
        folder: Folder of the scan.
        index: Number of the photo in the order of the frames, from 0.
        further: Numbers of further photos, or "auto" for up to five with the most different camera poses.

    Returns:
        The upright photo, the further ones posed relative to it, and the assumptions made.

    Raises:
        InputError: If the folder is of no known format, has no such photo or no poses, or a file is missing or damaged.
    """
    kind = scan_kind(folder)
    if kind is None:
        raise InputError(f"{folder} is no scan of {', '.join(FORMATS)}")
    found = (sorted(folder.glob(pattern)) for pattern in FORMATS[kind].pictures)
    named = next((files for files in found if files), [])
    pictures = sorted((one for one in named if last_number(one) >= 0), key=last_number)
    photo, files, notes, turns = _upright_photo(folder, kind, pictures, index)
    others: list[PosedPhoto] = []
    if further:
        first = _upright_pose(folder, kind, pictures[index], turns)
        if further == "auto":
            further = spread_out([scan_pose(folder, kind, one) for one in pictures], index)
        for number in map(int, further):
            other, other_files, _, other_turns = _upright_photo(folder, kind, pictures, number)
            pose = np.linalg.inv(first) @ _upright_pose(folder, kind, pictures[number], other_turns)
            others.append(PosedPhoto(photo=other, pose=pose))
            files = files | {f"{name} {number}": file for name, file in other_files.items()}
        notes = (f"Photos {', '.join(map(str, further))} of the scan were joined to it by its poses.", *notes)
    notes = (f"Photo {index} of the {kind} scan was used.", *notes)
    return CapturedPhoto(photo=photo, folder=folder, files=files, assumptions=notes, others=tuple(others))


def _upright_photo(
    folder: Path, kind: str, pictures: Sequence[Path], index: int
) -> tuple[RgbdPhoto, dict[str, Path], tuple[str, ...], int]:
    """The photo rotated upright, its files, the assumptions, and the number of quarter turns."""
    if not 0 <= index < len(pictures):
        raise InputError(f"{folder} holds {len(pictures)} pictures; there is no photo {index}")
    frame = FORMATS[kind].read(folder, pictures[index])
    depth_m, doubts = _drop_doubtful(frame)
    notes, turns, up = (*doubts, *frame.notes), 0, FORMATS[kind].up
    if up is not None:
        pose = scan_pose(folder, kind, pictures[index])
        if pose is None:
            notes = ("The scan says no pose of this photo: it was taken as upright.", *notes)
        else:  # quarter turns counterclockwise, from the world's up in picture coordinates
            turns = int(np.rint(np.arctan2(pose[up, 0], -pose[up, 1]) / (np.pi / 2))) % 4
    camera = _camera(frame)
    for _ in range((4 - turns) % 4):
        camera = rotated_clockwise(camera)
    depth_m, fill_notes = fill_scattered_holes(np.rot90(depth_m, turns).copy())
    rgb, depth_m, size_notes = to_common_size(np.rot90(frame.rgb, turns).copy(), depth_m)
    photo = RgbdPhoto(rgb=rgb, depth_m=depth_m, intrinsics=resized(camera, depth_m.shape[1], depth_m.shape[0]))
    return photo, frame.files, (*notes, *fill_notes, *size_notes), turns


def _upright_pose(folder: Path, kind: str, picture: Path, turns: int) -> Pose:
    """Transform from the upright picture's camera to the world. Raises InputError if the scan has no pose."""
    pose = scan_pose(folder, kind, picture)
    if pose is None:
        raise InputError(
            f"{folder}: photo {picture.name} has no pose, by which photos are joined; choose another with --photo"
        )
    quarter = np.array([[0.0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])  # counterclockwise
    return pose @ np.linalg.matrix_power(quarter, turns).T


def _camera(frame: ScanFrame) -> CameraIntrinsics:
    (height, width), (fx, fy, cx, cy) = frame.rgb.shape[:2], map(float, frame.lens)
    if not (0.2 * width < fx < 20 * width and 0.5 * fy < fx < 2 * fy and 0 < cx < width and 0 < cy < height):
        raise InputError(f"no camera of {width} x {height} pixels has fx {fx:g}, fy {fy:g}, cx {cx:g}, cy {cy:g}")
    return CameraIntrinsics(fx=fx, fy=fy, cx=cx, cy=cy, width=width, height=height)


def _drop_doubtful(frame: ScanFrame) -> tuple[DepthPixels, tuple[str, ...]]:
    """Depth without the pixels of the lowest confidence."""
    depth_m = frame.depth_m
    if frame.confidence is None:
        return depth_m, ()
    if frame.confidence.shape != depth_m.shape:
        raise InputError(f"the confidence of {frame.files['depth']} has another size; export the scan again")
    doubtful, measured = frame.confidence == 0, np.isfinite(depth_m)
    share = float((doubtful & measured).sum() / max(measured.sum(), 1))
    if share == 0 or share > MAX_DOUBTFUL:
        return depth_m, ()
    note = f"{100 * share:.0f} % of the depth, that of the lowest confidence, was left out."
    return np.where(doubtful, np.nan, depth_m), (note,)


def spread_out(poses: Sequence[Pose | None], first: int, most: int = 5) -> list[int]:
    """Chooses frames by farthest-point sampling of camera position and viewing direction.

    Args:
        poses: Transforms (4, 4) from camera to world, metres; None where a frame has none.
        first: Frame to start from; it must have a pose.
        most: Maximum number of frames to add.

    Returns:
        Indices of the added frames; fewer than `most` if the remaining ones are too close.
    """
    places = {
        index: np.concatenate([pose[:3, 3], pose[:3, 2] * 57.3 / DEGREES_A_METRE])  # metres, and direction as metres
        for index, pose in enumerate(poses)
        if pose is not None
    }
    chosen = [first]
    while len(chosen) <= most:
        new = {
            index: min(float(np.linalg.norm(place - places[one])) for one in chosen) for index, place in places.items()
        }
        best = max(new, key=lambda index: new[index])
        if new[best] < ENOUGH:
            break
        chosen.append(best)
    return chosen[1:]


# Pieces of several formats ------------------------------------------------------------------------------------------
def _nearest_pose(path: Path, key: float, column: int, values: slice, apart: float) -> Pose | None:
    """The pose (position, quaternion x y z w) of a table whose key is nearest, within `apart`."""
    rows = number_table(path) if path.is_file() else np.zeros((0, 0))
    if rows.shape[1] < values.stop or not len(rows):
        return None
    nearest = int(np.argmin(np.abs(rows[:, column] - key)))
    return _quaternion_pose(rows[nearest, values]) if abs(rows[nearest, column] - key) <= apart else None


def _quaternion_pose(values: Any, own_axes: np.ndarray | None = None) -> Pose | None:
    """Pose from position and quaternion (x, y, z, w); None if they are not a valid pose."""
    from scipy.spatial.transform import Rotation

    try:
        numbers = np.array(values, float)
    except (TypeError, ValueError):
        return None
    if numbers.shape != (7,) or not np.isfinite(numbers).all() or np.linalg.norm(numbers[3:]) < 0.5:
        return None
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.from_quat(numbers[3:]).as_matrix(), numbers[:3]
    return pose if own_axes is None else pose @ own_axes


def _confidence(file: Path) -> np.ndarray | None:
    return read_rgb(file)[0][..., 0] if file.is_file() else None


# Formats ------------------------------------------------------------------------------------------------------------
def _stray(folder: Path, depth: Path) -> ScanFrame:
    """rgb.mp4, depth/000000.png in millimetres, confidence/ (0, 1, 2), camera_matrix.csv of the video, odometry.csv.

    The table has poses and, of newer versions, the camera of each frame.
    """
    video, number = folder / "rgb.mp4", int(depth.stem)
    matrix = number_table(folder / "camera_matrix.csv")
    if matrix.shape != (3, 3):
        raise InputError(f"{folder / 'camera_matrix.csv'} holds {matrix.shape} numbers; it must be 3 x 3")
    said = number_table(folder / "odometry.csv") if (folder / "odometry.csv").is_file() else np.zeros((0, 0))
    own = said[said[:, 1] == number] if said.shape[1] >= 13 else said[:0]
    return ScanFrame(
        rgb=read_video_frame(video, number, "phone"),
        depth_m=read_depth(depth, MILLIMETRE)[0],
        lens=own[0, 9:13] if len(own) else matrix[[0, 1, 0, 1], [0, 1, 2, 2]],
        files={"rgb": video, "depth": depth},
        confidence=_confidence(folder / "confidence" / depth.name),
    )


def _stray_pose(folder: Path, depth: Path) -> Pose | None:
    return _nearest_pose(folder / "odometry.csv", float(depth.stem), 1, slice(2, 9), apart=0.5)


def _record3d(folder: Path, colour: Path) -> ScanFrame:
    """An unpacked .r3d: metadata (JSON: w, h, dw, dh, K by columns, perFrameIntrinsicCoeffs, poses), rgbd/0.jpg,
    rgbd/0.depth (float32 metres, LZFSE), rgbd/0.conf (0, 1, 2; LZFSE).

    Pictures are stored upright for portrait; those of a phone held in landscape are rotated.
    """
    depth, doubt = colour.with_suffix(".depth"), colour.with_suffix(".conf")
    said, rgb = read_json(folder / "metadata"), read_rgb(colour)[0]
    try:
        lens = [float(said["K"][at]) for at in (0, 4, 6, 7)]
        each = said.get("perFrameIntrinsicCoeffs") or []
        if int(colour.stem) < len(each) and len(each[int(colour.stem)]) == 4:
            lens = [float(value) for value in each[int(colour.stem)]]
        size, (columns, rows) = (int(said["h"]), int(said["w"])), (int(said.get("dw", 192)), int(said.get("dh", 256)))
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError):
        raise InputError(f"{folder / 'metadata'} lacks w, h or the camera K") from None
    if not (16 <= rows <= 4000 and 16 <= columns <= 4000) or rgb.shape[:2] != size:
        raise InputError(f"{folder / 'metadata'} has other sizes than its pictures; export the scan again")
    depth_m = np.frombuffer(read_lzfse(depth, 4 * rows * columns), "<f4").reshape(rows, columns).astype(np.float64)
    confidence = np.frombuffer(read_lzfse(doubt, rows * columns), np.uint8) if doubt.is_file() else None
    return ScanFrame(
        rgb=rgb,
        depth_m=np.where(np.isfinite(depth_m) & (depth_m > 0), depth_m, np.nan),
        lens=lens,
        files={"rgb": colour, "depth": depth, "camera": folder / "metadata"},
        confidence=None if confidence is None else confidence.reshape(rows, columns),
    )


def _record3d_pose(folder: Path, colour: Path) -> Pose | None:
    poses = read_json(folder / "metadata").get("poses")
    if not isinstance(poses, list) or int(colour.stem) >= len(poses) or not isinstance(poses[int(colour.stem)], list):
        return None
    values = poses[int(colour.stem)]
    return _quaternion_pose([*values[4:7], *values[:4]], Y_UP_CAMERA)


def _polycam(folder: Path, colour: Path) -> ScanFrame:
    """keyframes/: images, depth in millimetres, confidence (0, 127, 255) and cameras (JSON with fx, fy, cx, cy and the
    pose t_ij, y up).
    """
    depth, place = folder / "keyframes" / "depth" / f"{colour.stem}.png", _polycam_camera(colour)
    said = read_json(place)
    try:
        lens = [float(said[key]) for key in ("fx", "fy", "cx", "cy")]
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{place} lacks fx, fy, cx, cy") from None
    return ScanFrame(
        rgb=read_rgb(colour)[0],
        depth_m=read_depth(depth, MILLIMETRE)[0],
        lens=lens,
        files={"rgb": colour, "depth": depth, "camera": place},
        confidence=_confidence(folder / "keyframes" / "confidence" / depth.name),
    )


def _polycam_camera(colour: Path) -> Path:
    return colour.parent.with_name(colour.parent.name.replace("images", "cameras")) / f"{colour.stem}.json"


def _polycam_pose(folder: Path, colour: Path) -> Pose | None:
    said = read_json(_polycam_camera(colour))
    try:
        rows = [[float(said[f"t_{row}{column}"]) for column in range(4)] for row in range(3)]
    except (KeyError, TypeError, ValueError):
        return None
    return checked_pose(np.array([*rows, [0.0, 0.0, 0.0, 1.0]]) @ Y_UP_CAMERA)


def _scannet(folder: Path, colour: Path) -> ScanFrame:
    """color/0.jpg, depth/0.png in millimetres, intrinsic/intrinsic_color.txt, pose/0.txt (camera to world, z up)."""
    depth, intrinsic = folder / "depth" / f"{colour.stem}.png", folder / "intrinsic" / "intrinsic_color.txt"
    matrix = number_table(intrinsic)
    if matrix.shape[0] < 3 or matrix.shape[1] < 3:
        raise InputError(f"{intrinsic} holds no 4 x 4 matrix")
    return ScanFrame(
        rgb=read_rgb(colour)[0],
        depth_m=read_depth(depth, MILLIMETRE)[0],
        lens=matrix[[0, 1, 0, 1], [0, 1, 2, 2]],
        files={"rgb": colour, "depth": depth},
    )


def _scannet_pose(folder: Path, colour: Path) -> Pose | None:
    file = folder / "pose" / f"{colour.stem}.txt"
    return checked_pose(number_table(file)) if file.is_file() else None


def _tum(folder: Path, colour: Path) -> ScanFrame:
    """rgb/ and depth/ with PNGs named by their time in seconds, depth in 0.2 mm."""
    time_s = float(colour.stem)
    depths = [one for one in (folder / "depth").glob("*.png") if one.stem.replace(".", "", 1).isdigit()]
    depth = min(depths, key=lambda one: abs(float(one.stem) - time_s), default=None)
    if depth is None or abs(float(depth.stem) - time_s) > TUM_APART_S:
        raise InputError(f"{folder / 'depth'} holds no depth within {1e3 * TUM_APART_S:g} ms of {colour.name}")
    which = next((name for name in TUM_CAMERAS if name and name in str(folder.resolve())), "")
    rgb = read_rgb(colour)[0]
    note = f"The camera is that of {which}." if which else "No freiburg1, 2 or 3 in the folder's name: ROS's camera."
    return ScanFrame(
        rgb=rgb,
        depth_m=read_depth(depth, TUM_UNIT_M)[0],
        lens=np.array(TUM_CAMERAS[which]) * rgb.shape[1] / 640,
        files={"rgb": colour, "depth": depth},
        notes=(note,),
    )


def _tum_pose(folder: Path, colour: Path) -> Pose | None:
    return _nearest_pose(folder / "groundtruth.txt", float(colour.stem), 0, slice(1, 8), apart=TUM_POSE_APART_S)


FORMATS = {
    "Stray Scanner": ScanFormat(
        markers=("camera_matrix.csv", "depth"), pictures=("depth/*.png",), read=_stray, pose=_stray_pose, up=1
    ),
    "Record3D": ScanFormat(
        markers=("metadata", "rgbd"), pictures=("rgbd/*.jpg",), read=_record3d, pose=_record3d_pose, up=1
    ),
    "Polycam": ScanFormat(
        markers=("keyframes/depth",),
        pictures=("keyframes/corrected_images/*.jpg", "keyframes/images/*.jpg"),
        read=_polycam,
        pose=_polycam_pose,
        up=1,
    ),
    "ScanNet": ScanFormat(
        markers=("intrinsic", "color", "depth"),
        pictures=("color/*.jpg", "color/*.png"),
        read=_scannet,
        pose=_scannet_pose,
        up=2,
    ),
    **DATA_SETS,
    "TUM RGB-D": ScanFormat(
        markers=("rgb", "depth"), pictures=("rgb/*.png", "rgb/*.jpg"), read=_tum, pose=_tum_pose, up=None
    ),
}
