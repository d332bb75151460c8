"""One photo with depth of a scan, or several joined by its poses.

Folders of Stray Scanner, Record3D, Polycam (raw data), ScanNet and TUM RGB-D.

The depth of phones is coarse; colours are resampled to it as `read_photo` does, and depth of the lowest confidence is
left out. Phones store pictures as the sensor lies; the recorded pose says which side is up, and the photo is rotated
upright. Facts of the formats: table in docs/photos.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.shapes import DepthPixels, RgbPixels
from mmweaver.geometry.pinhole import resized, rotated_clockwise
from mmweaver.scene.multiview.scan_poses import scan_pose, spread_out
from mmweaver.scene.photo.capture_photo import CapturedPhoto
from mmweaver.scene.photo.lzfse import read_lzfse
from mmweaver.scene.photo.number_table import number_table
from mmweaver.scene.photo.picture_files import read_depth, read_rgb
from mmweaver.scene.photo.posed_photo import Pose, PosedPhoto
from mmweaver.scene.photo.sparse_depth import fill_scattered_holes
from mmweaver.scene.photo.video_frame import read_video_frame
from mmweaver.scene.read_photo import to_common_size

MILLIMETRE, TUM_UNIT_M = 0.001, 0.0002
MAX_DOUBTFUL = 0.7  # share of the depth: where more is of the lowest confidence there is nothing better
UP_AXIS = {"Stray Scanner": 1, "Record3D": 1, "ScanNet": 2}  # of the poses' world, y or z
TUM_APART_S = 0.03  # colour and depth farther apart are of other moments
# fx, fy, cx, cy of 640 x 480 (Sturm et al., IROS 2012, and the data set's page); by default those of ROS
TUM_CAMERAS = {
    "freiburg1": (517.3, 516.5, 318.6, 255.3), "freiburg2": (520.9, 521.0, 325.1, 249.7),
    "freiburg3": (535.4, 539.2, 320.1, 247.6), "": (525.0, 525.0, 319.5, 239.5),
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class _Frame:
    """What a folder says of one frame: pictures as they are stored, and where up is in them."""

    rgb: RgbPixels
    depth_m: DepthPixels
    camera: CameraIntrinsics  # of the colours
    files: dict[str, Path]
    up: tuple[float, float] = (0.0, 1.0)  # part of the upward direction to the right and to the top of the picture
    notes: tuple[str, ...] = ()


def scan_kind(folder: Path) -> str | None:
    """The name of the app or data set whose folder this is; None for others.

    >>> scan_kind(Path("no_such_folder")) is None
    True
    """
    markers = {
        "Stray Scanner": ("camera_matrix.csv", "depth"), "Record3D": ("metadata", "rgbd"),
        "Polycam": ("keyframes/depth",), "ScanNet": ("intrinsic", "color", "depth"), "TUM RGB-D": ("rgb", "depth"),
    }  # fmt: skip
    return next((kind for kind, names in markers.items() if all((folder / name).exists() for name in names)), None)


def refuse_unread(place: Path) -> None:
    """Raises InputError, with the way on, for what apps write that is not read as it is."""
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
    """Photo `index` of a scan, in the order of its frames, and further ones that show more of the room.

    `further`: their numbers, or "auto" for up to five whose cameras stand and look differently, by the scan's poses.
    Raises InputError where the folder is of no known kind, has no such photo or no poses, or a file is missing or
    damaged.
    """
    kind = scan_kind(folder)
    if kind is None:
        raise InputError(f"{folder} is no scan of Stray Scanner, Record3D, Polycam (raw data), ScanNet or TUM RGB-D")
    pictures = _pictures(folder, kind)
    photo, files, notes, turns = _upright_photo(folder, kind, pictures, index)
    others: list[PosedPhoto] = []
    if further:
        first = _pose_of(folder, kind, pictures, index, turns)
        if further == "auto":
            further = spread_out([scan_pose(folder, kind, one) for one in pictures], index)
        for number in further:
            other, other_files, _, other_turns = _upright_photo(folder, kind, pictures, int(number))
            pose = np.linalg.inv(first) @ _pose_of(folder, kind, pictures, int(number), other_turns)
            others.append(PosedPhoto(photo=other, pose=pose))
            files = files | {f"{name} {number}": file for name, file in other_files.items()}
        notes = (f"Photos {', '.join(map(str, further))} of the scan were joined to it by its poses.", *notes)
    notes = (f"Photo {index} of the {kind} scan was used.", *notes)
    return CapturedPhoto(photo=photo, folder=folder, files=files, assumptions=notes, others=tuple(others))


def _upright_photo(
    folder: Path, kind: str, pictures: Sequence[Path], index: int
) -> tuple[RgbdPhoto, dict[str, Path], tuple[str, ...], int]:
    """The photo turned upright, its files, what was assumed, and by how many quarters it was turned."""
    if not 0 <= index < len(pictures):
        raise InputError(f"{folder} holds {len(pictures)} pictures; there is no photo {index}")
    frame = _READERS[kind](folder, pictures[index], index)
    up, notes = frame.up, frame.notes
    if kind in UP_AXIS:
        pose, axis = scan_pose(folder, kind, pictures[index]), UP_AXIS[kind]
        if pose is None:
            notes = ("The scan says no pose of this photo: it was taken as upright.", *notes)
        else:
            up = (float(pose[axis, 0]), -float(pose[axis, 1]))
    turns = int(np.rint(np.arctan2(*up) / (np.pi / 2))) % 4  # counterclockwise, 90 degrees each
    camera = frame.camera
    for _ in range((4 - turns) % 4):
        camera = rotated_clockwise(camera)
    depth_m, fill_notes = fill_scattered_holes(np.rot90(frame.depth_m, turns).copy())
    rgb, depth_m, size_notes = to_common_size(np.rot90(frame.rgb, turns).copy(), depth_m)
    photo = RgbdPhoto(rgb=rgb, depth_m=depth_m, intrinsics=resized(camera, depth_m.shape[1], depth_m.shape[0]))
    return photo, frame.files, (*notes, *fill_notes, *size_notes), turns


def _pictures(folder: Path, kind: str) -> list[Path]:
    """The pictures by whose names frames are known, in order."""
    where, endings = {
        "Stray Scanner": ("depth", (".png",)), "Record3D": ("rgbd", (".jpg",)), "ScanNet": ("color", (".jpg", ".png")),
        "TUM RGB-D": ("rgb", (".png", ".jpg")), "Polycam": (f"keyframes/{_corrected(folder)}images", (".jpg",)),
    }[kind]  # fmt: skip
    place = folder / where
    files = [file for file in place.iterdir() if file.suffix.lower() in endings] if place.is_dir() else []
    return sorted(files, key=lambda file: (len(file.stem), file.stem) if file.stem.isdigit() else (0, file.stem))


def _corrected(folder: Path) -> str:
    """How the names of Polycam's folders begin."""
    return "corrected_" if (folder / "keyframes" / "corrected_images").is_dir() else ""


def _pose_of(folder: Path, kind: str, pictures: Sequence[Path], index: int, turns: int) -> Pose:
    """From the upright picture's camera to the world. Raises InputError where the scan does not say it."""
    pose = scan_pose(folder, kind, pictures[index])
    if pose is None:
        raise InputError(
            f"{folder}: photo {index} of the scan has no pose, by which photos are joined; choose another (--photo)"
        )
    quarter = np.array([[0.0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])  # counterclockwise
    return pose @ np.linalg.matrix_power(quarter, turns).T


def _stray(folder: Path, picture: Path, index: int) -> _Frame:
    """rgb.mp4, depth/000000.png in millimetres, confidence/ (0, 1, 2), camera_matrix.csv of the video, odometry.csv.

    The table has poses and, of newer versions, the camera of each frame.
    """
    depth = picture
    matrix = number_table(folder / "camera_matrix.csv")
    if matrix.shape != (3, 3):
        raise InputError(f"{folder / 'camera_matrix.csv'} holds {matrix.shape} numbers; it must be 3 x 3")
    video = folder / "rgb.mp4"
    number = int(depth.stem) if depth.stem.isdigit() else index
    rgb = read_video_frame(video, number, "phone")
    lens = [float(matrix[at]) for at in ((0, 0), (1, 1), (0, 2), (1, 2))]
    said = number_table(folder / "odometry.csv") if (folder / "odometry.csv").is_file() else np.zeros((0, 0))
    own = said[said[:, 1] == number] if said.shape[1] >= 13 else said[:0]
    if len(own):
        lens = [float(value) for value in own[0, 9:13]]
    depth_m, doubts = _drop_doubtful(read_depth(depth, MILLIMETRE)[0], folder / "confidence" / depth.name)
    files = {"rgb": video, "depth": depth}
    return _Frame(rgb=rgb, depth_m=depth_m, camera=_camera(*lens, rgb), files=files, notes=doubts)


def _record3d(folder: Path, picture: Path, index: int) -> _Frame:
    """An unpacked .r3d: metadata (JSON: w, h, dw, dh, K by columns, perFrameIntrinsicCoeffs, poses), rgbd/0.jpg,
    rgbd/0.depth (float32 metres, LZFSE), rgbd/0.conf (0, 1, 2; LZFSE).

    Pictures are stored upright in portrait; of a phone held across they lie on their side.
    """
    colour, depth, doubt = picture, picture.with_suffix(".depth"), picture.with_suffix(".conf")
    said, rgb = read_json(folder / "metadata"), read_rgb(colour)[0]
    try:
        lens = [float(said["K"][at]) for at in (0, 4, 6, 7)]
        each = said.get("perFrameIntrinsicCoeffs") or []
        if colour.stem.isdigit() and int(colour.stem) < len(each) and len(each[int(colour.stem)]) == 4:
            lens = [float(value) for value in each[int(colour.stem)]]
        width, height = int(said["w"]), int(said["h"])
        columns, rows = int(said.get("dw", 192)), int(said.get("dh", 256))
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError):
        raise InputError(f"{folder / 'metadata'} lacks w, h or the camera K") from None
    if not (16 <= rows <= 4000 and 16 <= columns <= 4000) or rgb.shape[:2] != (height, width):
        raise InputError(f"{folder / 'metadata'} has other sizes than its pictures; export the scan again")
    depth_m = np.frombuffer(read_lzfse(depth, 4 * rows * columns), "<f4").reshape(rows, columns).astype(np.float64)
    depth_m = np.where(np.isfinite(depth_m) & (depth_m > 0), depth_m, np.nan)
    doubts: tuple[str, ...] = ()
    if doubt.is_file():
        confidence = np.frombuffer(read_lzfse(doubt, rows * columns), np.uint8).reshape(rows, columns)
        depth_m, doubts = _drop_pixels(depth_m, confidence == 0)
    files = {"rgb": colour, "depth": depth, "camera": folder / "metadata"}
    return _Frame(rgb=rgb, depth_m=depth_m, camera=_camera(*lens, rgb), files=files, notes=doubts)


def _polycam(folder: Path, picture: Path, index: int) -> _Frame:
    """keyframes/: images, depth in millimetres, confidence (0, 127, 255) and cameras (JSON with fx, fy, cx, cy and the
    pose t_ij, y up).
    """
    keyframes = folder / "keyframes"
    colour, depth = picture, keyframes / "depth" / f"{picture.stem}.png"
    place = keyframes / f"{_corrected(folder)}cameras" / f"{picture.stem}.json"
    said, rgb = read_json(place), read_rgb(colour)[0]
    try:
        fx, fy, cx, cy, right, top = (float(said[key]) for key in ("fx", "fy", "cx", "cy", "t_10", "t_11"))
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{place} lacks fx, fy, cx, cy or the pose t_10, t_11") from None
    depth_m, doubts = _drop_doubtful(read_depth(depth, MILLIMETRE)[0], keyframes / "confidence" / depth.name)
    return _Frame(
        rgb=rgb, depth_m=depth_m, camera=_camera(fx, fy, cx, cy, rgb), up=(right, top), notes=doubts,
        files={"rgb": colour, "depth": depth, "camera": place},
    )  # fmt: skip


def _scannet(folder: Path, picture: Path, index: int) -> _Frame:
    """color/0.jpg, depth/0.png in millimetres, intrinsic/intrinsic_color.txt, pose/0.txt (camera to world, z up)."""
    colour, depth = picture, folder / "depth" / f"{picture.stem}.png"
    matrix = number_table(folder / "intrinsic" / "intrinsic_color.txt")
    if matrix.shape[0] < 3 or matrix.shape[1] < 3:
        raise InputError(f"{folder / 'intrinsic' / 'intrinsic_color.txt'} holds no 4 x 4 matrix")
    rgb = read_rgb(colour)[0]
    files = {"rgb": colour, "depth": depth}
    camera = _camera(matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2], rgb)
    depth_m = read_depth(depth, MILLIMETRE)[0]
    return _Frame(rgb=rgb, depth_m=depth_m, camera=camera, files=files)


def _tum(folder: Path, picture: Path, index: int) -> _Frame:
    """rgb/ and depth/ of PNGs named by their time in seconds, depth in 0.2 mm."""
    colour = picture
    depths = {_seconds(file): file for file in (folder / "depth").iterdir() if file.suffix == ".png"}
    nearest = min(depths, key=lambda time_s: abs(time_s - _seconds(colour)), default=np.inf)
    if abs(nearest - _seconds(colour)) > TUM_APART_S:
        raise InputError(f"{folder / 'depth'} holds no depth within {1e3 * TUM_APART_S:g} ms of {colour.name}")
    which = next((name for name in TUM_CAMERAS if name and name in str(folder.resolve())), "")
    rgb = read_rgb(colour)[0]
    numbers = np.array(TUM_CAMERAS[which]) * rgb.shape[1] / 640
    note = f"The camera is that of {which}." if which else "No freiburg1, 2 or 3 in the folder's name: ROS's camera."
    files = {"rgb": colour, "depth": depths[nearest]}
    return _Frame(
        rgb=rgb, depth_m=read_depth(depths[nearest], TUM_UNIT_M)[0], camera=_camera(*map(float, numbers), rgb),
        files=files, notes=(note,),
    )  # fmt: skip


_READERS = {"Stray Scanner": _stray, "Record3D": _record3d, "Polycam": _polycam, "ScanNet": _scannet, "TUM RGB-D": _tum}


def _seconds(file: Path) -> float:
    try:
        return float(file.stem)
    except ValueError:
        raise InputError(f"{file} is not named by its time in seconds, as TUM's pictures are") from None


def _camera(fx: float, fy: float, cx: float, cy: float, rgb: RgbPixels) -> CameraIntrinsics:
    height, width = rgb.shape[:2]
    if not (0.2 * width < fx < 20 * width and 0.5 < fx / fy < 2 and 0 < cx < width and 0 < cy < height):
        raise InputError(f"no camera of {width} x {height} pixels has fx {fx:g}, fy {fy:g}, cx {cx:g}, cy {cy:g}")
    return CameraIntrinsics(fx=fx, fy=fy, cx=cx, cy=cy, width=width, height=height)


def _drop_doubtful(depth_m: DepthPixels, file: Path) -> tuple[DepthPixels, tuple[str, ...]]:
    """Depth without the pixels of the lowest confidence, 0 in a picture of the same size; all of it without one."""
    if not file.is_file():
        return depth_m, ()
    confidence = read_rgb(file)[0][..., 0]
    if confidence.shape != depth_m.shape:
        raise InputError(f"{file} has another size than the depth; export the scan again")
    return _drop_pixels(depth_m, confidence == 0)


def _drop_pixels(depth_m: DepthPixels, doubtful: np.ndarray) -> tuple[DepthPixels, tuple[str, ...]]:
    share = float((doubtful & np.isfinite(depth_m)).sum() / max(np.isfinite(depth_m).sum(), 1))
    if share == 0 or share > MAX_DOUBTFUL:
        return depth_m, ()
    note = f"{100 * share:.0f} % of the depth, that of the lowest confidence, was left out."
    return np.where(doubtful, np.nan, depth_m), (note,)
