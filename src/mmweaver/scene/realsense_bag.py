"""One photo with depth of a ROS bag: a RealSense's own recording (.bag of its viewer), or topics of its ROS driver.

ROS 1 (.bag) or ROS 2: a .db3 or .mcap, or the folder that `ros2 bag record` writes. Needs rosbags (extra `capture`).
Depth that is aligned with the colours is used unchanged; otherwise the photo has the depth camera's view, coloured by
reprojection as in a capture folder. Facts of the format: librealsense's ROS bag layout.
"""

from collections.abc import Callable
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.safe_files.regular_files import check_regular, foreign_errors
from mmweaver.core.shapes import RgbPixels
from mmweaver.scene.photo.capture_photo import D455_BASELINE_M, CapturedPhoto, coloured
from mmweaver.scene.photo.depth_grid import fill_scattered_holes
from mmweaver.scene.read_photo import to_common_size

IMAGE, CAMERA = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
UNIT_TOPIC = "Depth_Units/value"  # of librealsense: metres of one count
DEFAULT_UNIT_M = 0.001
DEPTHS, COLOURS = ("16uc1", "mono16", "z16"), {"rgb8": 1, "bgr8": -1}  # encodings; the order of the channels
APART_S = 0.1
BROKEN = "no ROS bag that can be read ({reason}); record it again"
ROS1, ROS2 = (".bag",), (".db3", ".mcap")
ROS2_FOLDER = "metadata.yaml"  # what a folder of `ros2 bag record` holds


def is_bag(path: Path) -> bool:
    """Whether a path is a ROS bag: a .bag, .db3 or .mcap file, or a folder with metadata.yaml."""
    return (path.suffix.lower() in (*ROS1, *ROS2) and path.is_file()) or (path / ROS2_FOLDER).is_file()


def read_bag_photo(path: Path, index: int = 0) -> CapturedPhoto:
    """Reads one photo of a ROS bag.

    Args:
        path: The bag.
        index: Number of the depth picture, from 0; the colour picture is the nearest in time, within 0.1 s.

    Returns:
        The photo with the assumptions made.

    Raises:
        InputError: If rosbags is not installed, the file is not a bag, or it has no such photo with its cameras.
    """
    opened, read = _reader(path)
    for file in sorted(path.iterdir()) if path.is_dir() else (path,):
        check_regular(file)
    with foreign_errors(path, BROKEN), opened(path) as bag:
        topics = _topics(bag)
        aligned = [topic for topic in topics["depth"] if "aligned" in topic]
        depth_topic, colour_topic = (aligned or topics["depth"])[0], topics["colour"][0]
        depth, time_ns = _message(bag, read, depth_topic, index)
        colours, apart_ns = _nearest(bag, read, colour_topic, time_ns)
        intrinsics, colour_intrinsics = (_camera(bag, read, topic, path) for topic in (depth_topic, colour_topic))
        unit_m = _unit_m(bag, read)
    if apart_ns > APART_S * 1e9:
        raise InputError(f"{path}: no colour picture within {APART_S:g} s of depth {index}; choose another photo")
    counts, rgb = _depth_counts(depth, path), _pixels(colours, path)
    for what, picture, camera in (("depth", counts, intrinsics), ("colour", rgb, colour_intrinsics)):
        if picture.shape[:2] != (camera.height, camera.width):
            raise InputError(f"{path}: its {what} pictures have another size than its camera_info says")
    depth_m = np.where(counts > 0, counts * unit_m, np.nan)
    if not np.isfinite(depth_m).any():
        raise InputError(f"{path}: photo {index} has no depth at all; choose another (--photo)")
    notes = (f"Photo {index} of the bag was used.",)
    if not aligned:
        rgb = coloured(depth_m, intrinsics, rgb, colour_intrinsics)
        notes += (
            "Depth and colours are not aligned: the photo is the depth camera's, and the colour camera was assumed"
            f" {1e3 * D455_BASELINE_M:.0f} mm to its side.",
        )
    depth_m, fill_notes = fill_scattered_holes(depth_m)
    rgb, depth_m, size_notes = to_common_size(rgb, depth_m)
    photo = RgbdPhoto(rgb=rgb, depth_m=depth_m, intrinsics=intrinsics)
    assumed = (*notes, *fill_notes, *size_notes)
    return CapturedPhoto(photo=photo, folder=path.parent, files={"bag": path}, assumptions=assumed)


def _reader(path: Path) -> tuple[Any, Callable[..., Any]]:
    """The class that opens a bag and the function that deserializes its messages.

    Raises InputError if rosbags is not installed.
    """
    need("capture", str(path), "rosbags")
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys import Stores, get_typestore

    if path.suffix.lower() in ROS1:
        return rosbag1.Reader, get_typestore(Stores.ROS1_NOETIC).deserialize_ros1
    return rosbag2.Reader, get_typestore(Stores.LATEST).deserialize_cdr


def _topics(bag: Any) -> dict[str, list[str]]:
    """Picture topics by content. Raises InputError if depth or colour is missing."""
    names = sorted({one.topic for one in bag.connections if one.msgtype == IMAGE})
    depth = [name for name in names if "depth" in name.lower()]
    colour = [name for name in names if name not in depth and ("color" in name.lower() or "rgb" in name.lower())]
    if not depth or not colour:
        raise InputError(f"{bag.path} holds no topics of depth and colour pictures (it has: {', '.join(names) or '-'})")
    return {"depth": depth, "colour": colour}


def _connections(bag: Any, topic: str) -> list[Any]:
    return [one for one in bag.connections if one.topic == topic]


def _message(bag: Any, read: Callable[..., Any], topic: str, index: int) -> tuple[Any, int]:
    """Message `index` of a topic, and its time in nanoseconds."""
    count = 0
    for count, (connection, time_ns, raw) in enumerate(bag.messages(_connections(bag, topic))):
        if count == index:
            return read(raw, connection.msgtype), time_ns
    raise InputError(f"{bag.path} holds {count + 1} depth pictures; there is no photo {index}")


def _nearest(bag: Any, read: Callable[..., Any], topic: str, time_ns: int) -> tuple[Any, int]:
    """The message of a topic nearest in time, and the difference in nanoseconds."""
    best: tuple[int, Any, Any] | None = None
    for connection, own_ns, raw in bag.messages(_connections(bag, topic)):
        apart = abs(own_ns - time_ns)
        if best is None or apart < best[0]:
            best = apart, connection, raw
        elif own_ns > time_ns:
            break
    if best is None:
        raise InputError(f"{bag.path} holds no pictures in {topic}")
    return read(best[2], best[1].msgtype), best[0]


def _camera(bag: Any, read: Callable[..., Any], topic: str, path: Path) -> CameraIntrinsics:
    """Intrinsics of a picture topic: from the camera_info with the longest common prefix."""
    found = [one for one in bag.connections if one.msgtype == CAMERA]
    if not found:
        raise InputError(f"{path} holds no camera_info, so its cameras are not known")
    own = max(found, key=lambda one: _shared_parts(one.topic, topic))
    raw = next((raw for _, _, raw in bag.messages([own])), None)
    if raw is None:
        raise InputError(f"{path} holds no message of {own.topic}")
    said = read(raw, own.msgtype)
    fx, fy, cx, cy = (float((said.K if hasattr(said, "K") else said.k)[at]) for at in (0, 4, 2, 5))
    width, height = int(said.width), int(said.height)
    if not (32 <= width <= 8000 and 32 <= height <= 8000 and 1 < fx < 1e6 and 1 < fy < 1e6 and max(cx, cy) < 1e5):
        raise InputError(f"{path}: no camera has {width} x {height} pixels with fx {fx:g}, fy {fy:g}")
    return CameraIntrinsics(fx=fx, fy=fy, cx=cx, cy=cy, width=width, height=height)


def _shared_parts(one: str, other: str) -> int:
    """Length of the common prefix of two topics, in parts."""
    pairs = zip(one.strip("/").split("/"), other.strip("/").split("/"), strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


def _unit_m(bag: Any, read: Callable[..., Any]) -> float:
    """Metres of one count of depth."""
    for one in bag.connections:
        if one.topic.endswith(UNIT_TOPIC):
            for _, _, raw in bag.messages([one]):
                value = float(read(raw, one.msgtype).data)
                return value if 1e-6 < value < 0.1 else DEFAULT_UNIT_M
    return DEFAULT_UNIT_M


def _depth_counts(message: Any, path: Path) -> np.ndarray:
    if message.encoding.lower() not in DEPTHS:
        raise InputError(f"{path}: depth pictures are {message.encoding}; they must be 16UC1")
    kind = ">u2" if message.is_bigendian else "<u2"
    return _rows(message, path, 2).view(kind)[:, : message.width]


def _pixels(message: Any, path: Path) -> RgbPixels:
    order = COLOURS.get(message.encoding.lower())
    if order is None:
        raise InputError(f"{path}: colour pictures are {message.encoding}; they must be rgb8 or bgr8")
    rows = _rows(message, path, 3)[:, : 3 * message.width].reshape(message.height, message.width, 3)
    return np.ascontiguousarray(rows[..., ::order])


def _rows(message: Any, path: Path, pixel_bytes: int) -> np.ndarray:
    """The picture's bytes (row, byte)."""
    height, step = int(message.height), int(message.step)
    if step < pixel_bytes * message.width or step % pixel_bytes or len(message.data) != height * step:
        raise InputError(f"{path}: a picture of {message.width} x {height} pixels has {len(message.data)} bytes")
    return np.ascontiguousarray(np.frombuffer(message.data, np.uint8).reshape(height, step))
