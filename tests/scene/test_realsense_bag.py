"""ROS 1 bags, written by rosbags as a RealSense's viewer and as its ROS driver name their topics."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import resized
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.realsense_bag import is_bag, read_bag_photo
from mmweaver.weaver.front_door import Weaver

pytest.importorskip("rosbags")
SIZE = (320, 240)
VIEWER = {
    "depth": "/device_0/sensor_0/Depth_0/image/data", "depth_camera": "/device_0/sensor_0/Depth_0/info/camera_info",
    "colour": "/device_0/sensor_1/Color_0/image/data", "colour_camera": "/device_0/sensor_1/Color_0/info/camera_info",
    "unit": "/device_0/sensor_0/option/Depth_Units/value",
}  # fmt: skip
DRIVER = {
    "depth": "/camera/aligned_depth_to_color/image_raw", "depth_camera": "/camera/aligned_depth_to_color/camera_info",
    "colour": "/camera/color/image_raw", "colour_camera": "/camera/color/camera_info",
}  # fmt: skip


def write_bag(path: Path, topics: dict[str, str], *, unit_m: float = 0.001, frames: int = 2) -> np.ndarray:
    """The sample photo as the last of some pictures, the others black; returns its depth in metres."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    made = types.types
    photo, _ = sample_photo()
    camera, step = resized(photo.intrinsics, *SIZE), photo.rgb.shape[1] // SIZE[0]
    rgb = np.array(Image.fromarray(photo.rgb).resize(SIZE, Image.Resampling.BOX))
    depth_m = np.nan_to_num(photo.depth_m[::step, ::step])

    def header(number: int):
        stamp = made["builtin_interfaces/msg/Time"](sec=number, nanosec=0)
        return made["std_msgs/msg/Header"](seq=number, stamp=stamp, frame_id="camera")

    def picture(number: int, values: np.ndarray, encoding: str):
        rows = np.ascontiguousarray(values).view(np.uint8).reshape(values.shape[0], -1)
        return made["sensor_msgs/msg/Image"](
            header=header(number), height=values.shape[0], width=values.shape[1], encoding=encoding, is_bigendian=0,
            step=rows.shape[1], data=rows.ravel(),
        )  # fmt: skip

    region = made["sensor_msgs/msg/RegionOfInterest"](x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
    matrix = np.array([camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1], float)
    info = made["sensor_msgs/msg/CameraInfo"](
        header=header(0), height=SIZE[1], width=SIZE[0], distortion_model="", D=np.zeros(5), K=matrix,
        R=np.eye(3).ravel(), P=np.zeros(12), binning_x=0, binning_y=0, roi=region,
    )  # fmt: skip
    with Writer(path) as bag:
        links = {}
        for name, topic in topics.items():
            kind = {"unit": "std_msgs/msg/Float32"}.get(
                name, "sensor_msgs/msg/CameraInfo" if "camera" in name else "sensor_msgs/msg/Image"
            )  # fmt: skip
            links[name] = bag.add_connection(topic, kind, typestore=types)

        def say(name: str, time_s: float, message) -> None:
            raw = types.serialize_ros1(message, links[name].msgtype)
            bag.write(links[name], int(time_s * 1e9), raw)

        if "unit" in topics:
            say("unit", 0, made["std_msgs/msg/Float32"](data=unit_m))
        for name in ("depth_camera", "colour_camera"):
            say(name, 0, info)
        for number in range(frames):
            is_last = number == frames - 1
            counts = np.round(depth_m / unit_m).astype("<u2") if is_last else np.zeros(depth_m.shape, "<u2")
            say("depth", number + 1, picture(number, counts, "16UC1"))
            say("colour", number + 1.01, picture(number, rgb if is_last else np.zeros_like(rgb), "rgb8"))
    return depth_m


def test_aligned_topics_are_the_photo(tmp_path: Path):
    path = tmp_path / "room.bag"
    depth_m = write_bag(path, DRIVER)
    assert is_bag(path)
    found = read_bag_photo(path, 1)
    step = found.photo.depth_m.shape[0] // SIZE[1]
    assert np.nanmedian(np.abs(found.photo.depth_m[::step, ::step] - depth_m)[depth_m > 0]) < 0.002
    assert found.photo.rgb.mean() > 50
    assert not any("aligned" in note for note in found.assumptions)


def test_the_viewers_own_recording_has_its_unit_and_is_aligned_here(tmp_path: Path):
    path = tmp_path / "room.bag"
    depth_m = write_bag(path, VIEWER, unit_m=0.0005)
    found = read_bag_photo(path, 1)
    step = found.photo.depth_m.shape[0] // SIZE[1]
    assert np.nanmedian(np.abs(found.photo.depth_m[::step, ::step] - depth_m)[depth_m > 0]) < 0.002
    assert any("not aligned" in note for note in found.assumptions)
    room = Weaver().read_capture(path, photo=1)
    assert room.scene.floor_z_m == pytest.approx(Weaver().sample_room().scene.floor_z_m, abs=0.05)
    assert "bag" in room.inputs


def test_others_are_refused_in_one_line(tmp_path: Path):
    path = tmp_path / "room.bag"
    write_bag(path, DRIVER)
    with pytest.raises(InputError, match=r"2 depth pictures.*9"):
        read_bag_photo(path, 9)
    with pytest.raises(InputError, match="no depth"):
        read_bag_photo(path, 0)
    whole = path.read_bytes()
    for damaged in (b"", b"#ROSBAG V2.0\n", whole[: len(whole) // 3], b"no bag" * 100):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match=r"room\.bag"):
            read_bag_photo(path)
    write_bag(tmp_path / "colours.bag", {name: topic for name, topic in DRIVER.items() if "depth" not in name} | {
        "depth": "/camera/other/image_raw", "depth_camera": "/camera/other/camera_info"})  # fmt: skip
    with pytest.raises(InputError, match="/camera/color/image_raw"):
        read_bag_photo(tmp_path / "colours.bag")


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
def test_ros_2_is_the_same(storage: str, tmp_path: Path):
    from rosbags.convert import convert
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.typesys import Stores, get_typestore

    write_bag(tmp_path / "room.bag", DRIVER)
    types = {"default_typestore": get_typestore(Stores.ROS1_NOETIC), "typestore": get_typestore(Stores.ROS2_HUMBLE)}
    nothing = dict.fromkeys(("exclude_topics", "include_topics", "exclude_msgtypes", "include_msgtypes"), ())
    convert([tmp_path / "room.bag"], tmp_path / "room", dst_storage=StoragePlugin[storage.upper()], dst_version=9,
            compress=None, compress_mode="file", **types, **nothing)  # fmt: skip
    first = read_bag_photo(tmp_path / "room.bag", 1).photo
    for place in (tmp_path / "room", next((tmp_path / "room").glob("*.[dm]*"))):
        assert is_bag(place)
        again = read_bag_photo(place, 1).photo
        assert again.intrinsics == first.intrinsics
        np.testing.assert_array_equal(again.rgb, first.rgb)
        np.testing.assert_array_equal(again.depth_m, first.depth_m)
    (tmp_path / "other.db3").write_bytes(b"no bag" * 100)
    with pytest.raises(InputError, match=r"other\.db3"):
        read_bag_photo(tmp_path / "other.db3")
