"""Results as ROS 2 bags and MCAP files: point cloud, skeleton and range-Doppler map per frame.

Both use the axes of ROS (REP 103): x ahead, y to the left, z up, frame "radar". Time starts at 0.
"""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from mmweaver.core.optional_packages import need
from mmweaver.core.records import PointCloud
from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import BONES
from mmweaver.datasets.formats import export_format
from mmweaver.io.stored_result import StoredResult
from mmweaver.signal.spectra import range_doppler_power

FRAME = "radar"
POINT_FIELDS = ("x", "y", "z", "velocity", "snr_db")


def ros_axes(points_m: Float[Array, "*shape 3"]) -> Float[Array, "*shape 3"]:
    """Converts (x right, y away, z up) to (x ahead, y left, z up)."""
    return np.stack([points_m[..., 1], -points_m[..., 0], points_m[..., 2]], axis=-1)


@export_format("ros2", "ROS 2 bag")
def write_ros2(result: StoredResult, out: Path) -> str:
    """Writes a ROS 2 bag (SQLite): /radar/points (PointCloud2), /radar/skeleton_N (PoseArray), /radar/range_doppler_db.

    The map is a Float32MultiArray (range, doppler) of power in dB.

    Raises:
        InputError: If rosbags is not installed.
    """
    need("export", "a ROS 2 bag", "rosbags")
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    make = {name.split("/")[-1]: kind for name, kind in store.types.items()}
    power_db = _power_db(result)
    with Writer(out / "bag", version=9) as bag:
        topics = {
            "/radar/points": "sensor_msgs/msg/PointCloud2",
            "/radar/range_doppler_db": "std_msgs/msg/Float32MultiArray",
        }
        topics |= {f"/radar/skeleton_{index}": "geometry_msgs/msg/PoseArray" for index in range(len(result.poses))}
        connections = {topic: bag.add_connection(topic, kind, typestore=store) for topic, kind in topics.items()}
        for index, time_s in enumerate(result.cube.grid.frame_time_s):
            stamp = round(float(time_s) * 1e9)
            header = make["Header"](stamp=make["Time"](sec=stamp // 10**9, nanosec=stamp % 10**9), frame_id=FRAME)
            messages: dict[str, Any] = {"/radar/points": _cloud(make, header, packed_points(result.points, index))}
            messages["/radar/range_doppler_db"] = _array(make, power_db[index], ("range", "doppler"))
            for person, pose in enumerate(result.poses):
                messages[f"/radar/skeleton_{person}"] = _poses(make, header, ros_axes(pose.joints_m[index]))
            for topic, message in messages.items():
                bag.write(connections[topic], stamp, store.serialize_cdr(message, topics[topic]))
    return f"a ROS 2 bag of {len(power_db)} frames"


@export_format("mcap", "MCAP, for Foxglove", ending=".mcap")
def write_mcap(result: StoredResult, out: Path) -> str:
    """Writes `result.mcap` with Foxglove's schemas: /radar/points (PointCloud), /radar/skeleton (SceneUpdate).

    Raises:
        InputError: If foxglove-sdk is not installed.
    """
    need("export", "MCAP", "foxglove")
    import foxglove
    from foxglove import messages as schema

    numeric = schema.PackedElementFieldNumericType.Float32
    fields = [
        schema.PackedElementField(name=name, offset=4 * place, type=numeric) for place, name in enumerate(POINT_FIELDS)
    ]
    context = foxglove.Context()
    points = foxglove.Channel(
        "/radar/points", schema=schema.PointCloud.get_schema(), message_encoding="protobuf", context=context
    )
    scene = foxglove.Channel(
        "/radar/skeleton", schema=schema.SceneUpdate.get_schema(), message_encoding="protobuf", context=context
    )
    with foxglove.open_mcap(str(out / "result.mcap"), context=context):
        for index, time_s in enumerate(result.cube.grid.frame_time_s):
            stamp = round(float(time_s) * 1e9)
            when = schema.Timestamp(sec=stamp // 10**9, nsec=stamp % 10**9)
            cloud = schema.PointCloud(
                timestamp=when,
                frame_id=FRAME,
                point_stride=4 * len(POINT_FIELDS),
                fields=fields,
                data=packed_points(result.points, index).tobytes(),
            )
            points.log(cloud.encode(), log_time=stamp)
            if result.poses:
                scene.log(_skeletons(schema, result, index, when).encode(), log_time=stamp)
    return "an MCAP file"


def packed_points(points: PointCloud, frame: int) -> Float[Array, "point 5"]:
    """Points of one frame in ROS axes.

    Args:
        points: The cloud.
        frame: Index of the frame.

    Returns:
        Float32 (point, 5): x, y, z in metres, velocity in m/s, SNR in dB.
    """
    own = points.select(points.frame == frame)
    place = ros_axes(own.xyz_m)
    return np.concatenate([place, own.radial_velocity_mps[:, None], own.snr_db[:, None]], axis=-1).astype("<f4")


def _power_db(result: StoredResult) -> Float[Array, "frame range doppler"]:
    scale = result.cube.scale if np.isfinite(result.cube.scale) else 1.0
    power = range_doppler_power(result.cube) * scale**2
    return (10 * np.log10(np.maximum(power, np.finfo(float).tiny))).astype(np.float32)


def _cloud(make: dict[str, Any], header: Any, rows: Float[Array, "point 5"]) -> Any:
    kind = make["PointField"]
    fields = [
        kind(name=name, offset=4 * place, datatype=kind.FLOAT32, count=1) for place, name in enumerate(POINT_FIELDS)
    ]
    data: UInt8[Array, " byte"] = np.frombuffer(rows.tobytes(), np.uint8)
    return make["PointCloud2"](
        header=header,
        height=1,
        width=len(rows),
        fields=fields,
        is_bigendian=False,
        point_step=4 * len(POINT_FIELDS),
        row_step=len(data),
        data=data,
        is_dense=True,
    )


def _array(make: dict[str, Any], values: np.ndarray, names: tuple[str, ...]) -> Any:
    dims = [
        make["MultiArrayDimension"](label=name, size=size, stride=int(np.prod(values.shape[place:])))
        for place, (name, size) in enumerate(zip(names, values.shape, strict=True))
    ]
    return make["Float32MultiArray"](layout=make["MultiArrayLayout"](dim=dims, data_offset=0), data=values.ravel())


def _poses(make: dict[str, Any], header: Any, joints_m: Float[Array, "22 3"]) -> Any:
    level = make["Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
    poses = [
        make["Pose"](position=make["Point"](x=float(x), y=float(y), z=float(z)), orientation=level)
        for x, y, z in joints_m
    ]
    return make["PoseArray"](header=header, poses=poses)


def _skeletons(schema: Any, result: StoredResult, index: int, when: Any) -> Any:
    """Bones of all people as lines."""
    entities = []
    for person, pose in enumerate(result.poses):
        joints_m = ros_axes(pose.joints_m[index])
        ends = [schema.Point3(x=float(x), y=float(y), z=float(z)) for bone in BONES for x, y, z in joints_m[list(bone)]]
        lines = schema.LinePrimitive(
            type=schema.LinePrimitiveLineType.LineList,
            thickness=0.03,
            points=ends,
            color=schema.Color(r=0.9, g=0.6, b=0.2, a=1.0),
        )
        entities.append(schema.SceneEntity(timestamp=when, frame_id=FRAME, id=f"person {person}", lines=[lines]))
    return schema.SceneUpdate(entities=entities)
