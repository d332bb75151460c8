"""ROS 1 and 2 bags of points: PointCloud2 of any driver, and the RadarScan of TI's ti_mmwave_rospkg.

ROS's axes (x ahead, y to the left, z up) become ours. A PointCloud2 is a frame; its velocity is the field velocity,
doppler or v, its intensity the field intensity or snr. A RadarScan is one point, and a new frame begins where point_id
does not grow. Needs rosbags (extra `capture`).

Reference: sensor_msgs/PointCloud2, PointField; radar-lab/ti_mmwave_rospkg, msg/RadarScan.msg.
"""

from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.regular_files import check_regular, foreign_errors
from mmweaver.io.point_clouds.point_log import LoggedCloud, logged_cloud, point_format

SUFFIXES, FOLDER = (".bag", ".db3", ".mcap"), "metadata.yaml"
CLOUD, SCAN = "sensor_msgs/msg/PointCloud2", "RadarScan"
TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}  # of PointField
VELOCITY, INTENSITY, SNR = (
    ("velocity", "doppler", "v", "v_doppler_mps", "radial_speed", "vel"),
    ("intensity", "power"),
    ("snr", "snr_db"),
)
MAX_POINTS = 20_000_000
BROKEN = "no ROS bag that can be read ({reason}); record it again"


def _is_bag(path: Path, head: bytes) -> bool:
    return path.suffix.lower() in SUFFIXES or (path.is_dir() and (path / FOLDER).is_file())


@point_format("ros", "ROS bag of PointCloud2 or ti_mmwave_rospkg's RadarScan", _is_bag)
def read_ros_points(path: Path) -> LoggedCloud:
    """Reads the first topic of points of a bag.

    Args:
        path: .bag, .db3, .mcap, or the folder that `ros2 bag record` writes.

    Returns:
        The cloud; velocity, intensity and SNR are nan if the messages have none.

    Raises:
        InputError: If rosbags is not installed, or the bag is damaged or has no points.
    """
    need("capture", str(path), "rosbags")
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    for file in sorted(path.iterdir()) if path.is_dir() else (path,):
        check_regular(file)
    with foreign_errors(path, BROKEN), AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as bag:
        topics = sorted({(one.topic, one.msgtype) for one in bag.connections})
        chosen = [one for one in topics if one[1] == CLOUD] or [one for one in topics if one[1].endswith(SCAN)]
        if not chosen:
            raise InputError(
                f"{path} holds no PointCloud2 and no RadarScan, but {', '.join(one for one, _ in topics) or 'nothing'}"
            )
        topic, kind = chosen[0]
        links = [one for one in bag.connections if one.topic == topic]
        messages = (bag.deserialize(raw, link.msgtype) for link, _, raw in bag.messages(connections=links))
        clouds = [_cloud(one) for one in messages] if kind == CLOUD else _scans(list(messages))
        if sum(map(len, clouds)) > MAX_POINTS:
            raise InputError(f"{path} holds more than {MAX_POINTS:,} points; cut it into several bags")
    table = np.concatenate([*clouds, np.zeros((0, 6))])
    others = [one for one, _ in chosen[1:]]
    return logged_cloud(
        np.repeat(np.arange(len(clouds)), [len(cloud) for cloud in clouds]),
        table[:, [1, 0, 2]] * [-1, 1, 1],
        table[:, 3],
        snr_db=table[:, 5],
        intensity=table[:, 4],
        num_frames=len(clouds),
        notes=(f"points of {topic}; not those of {', '.join(others)}",) if others else (),
    )


def _cloud(message: Any) -> np.ndarray:
    """Rows of x, y, z, velocity, intensity and SNR; nan where a field is missing."""
    order = ">" if message.is_bigendian else "<"
    fields = {one.name.lower(): (int(one.offset), order + TYPES[int(one.datatype)]) for one in message.fields}
    size, step = int(message.width) * int(message.height), int(message.point_step)
    data = np.frombuffer(message.data, np.uint8, count=size * step).reshape(size, step)

    def column(*names: str) -> np.ndarray:
        found = next((fields[name] for name in names if name in fields), None)
        if found is None:
            return np.full(size, np.nan)
        at, kind = found
        return np.ascontiguousarray(data[:, at : at + np.dtype(kind).itemsize]).view(kind)[:, 0].astype(float)

    table = np.column_stack(
        [column("x"), column("y"), column("z"), column(*VELOCITY), column(*INTENSITY), column(*SNR)]
    )
    return table[np.isfinite(table[:, :3]).all(axis=1)]


def _scans(messages: list[Any]) -> list[np.ndarray]:
    """Frames of RadarScan messages."""
    rows = np.array([[one.x, one.y, one.z, one.velocity, one.intensity, np.nan] for one in messages], float)
    number = np.array([one.point_id for one in messages], int)
    starts = np.flatnonzero(np.diff(number) <= 0) + 1
    return np.split(rows.reshape(-1, 6), starts) if len(rows) else []
