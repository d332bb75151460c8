"""Losses by the board's counters, logs without points, and formats of other programs, written here."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.io.point_clouds.read_points import read_points
from mmweaver.io.point_clouds.ti_uart import MAGIC, read_ti_uart
from tests.io.point_clouds.test_read_points import XYZV, out_of_box, packet

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases"


def test_frames_without_points_at_the_end_count(tmp_path: Path):
    (tmp_path / "log.dat").write_bytes(b"".join(out_of_box(5 + k, XYZV if k < 3 else XYZV[:0]) for k in range(6)))
    cloud = read_points(tmp_path / "log.dat")
    assert (cloud.num_frames, int(cloud.frame.max())) == (6, 2)
    assert main(["points", str(tmp_path / "log.dat"), "-o", str(tmp_path / "points.npz"), "--quiet"]) == 0
    assert read_points(tmp_path / "points.npz").num_frames == 6


def test_missing_packets_are_frames_without_points(tmp_path: Path):
    (tmp_path / "log.dat").write_bytes(b"".join(out_of_box(number, XYZV) for number in (10, 11, 14, 15, 2, 3)))
    cloud = read_points(tmp_path / "log.dat")
    assert sorted(set(cloud.frame.tolist())) == [0, 1, 4, 5, 6, 7]
    assert any("2 of 8" in note for note in cloud.notes)
    assert any("restarts" in note for note in cloud.notes)


def test_a_log_of_another_demo_is_refused_with_its_tlvs(tmp_path: Path):
    log = b"".join(packet(k, [(2, bytes(64)), (1040, bytes(136))], 0) for k in range(3))
    (tmp_path / "log.dat").write_bytes(log)
    with pytest.raises(InputError, match="2, 1040"):
        read_points(tmp_path / "log.dat")
    (tmp_path / "log.dat").write_bytes(b"".join(packet(k, [(2, bytes(64)), (6, bytes(24))], 0) for k in range(3)))
    assert read_points(tmp_path / "log.dat").num_frames == 3  # an out-of-box demo that saw nothing


def test_people_counting_in_two_dimensions(tmp_path: Path):
    """A header of 52 bytes; TLV lengths include their own eight bytes."""
    points = struct.pack("<4f", 2.0, 0.3, -0.5, 100.0) + struct.pack("<4f", 1.0, -0.3, 0.5, 10.0)
    body = struct.pack("<II", 6, len(points) + 8) + points
    numbers = (0x02010004, 0xA1642, 123456, 52 + len(body), 77, 0, 9, 8, 7, 6)
    (tmp_path / "log.dat").write_bytes(struct.pack("<8s10I2H", MAGIC, *numbers, 1, 0) + body)
    found = read_ti_uart(tmp_path / "log.dat")
    assert found.frame_number.tolist() == [77]
    cloud = found.points
    assert np.arctan2(cloud.x_m, cloud.y_m) == pytest.approx([0.3, -0.3])
    assert np.hypot(cloud.x_m, cloud.y_m) == pytest.approx([2.0, 1.0])
    assert cloud.snr_db == pytest.approx([20.0, 10.0])


def test_replay_of_tis_visualizer(tmp_path: Path):
    def one(number: int, points: list) -> dict:
        return {"frameData": {"error": 0, "frameNum": number, "pointCloud": points}, "timestamp": 1_700_000_000_000}

    rows = [[*map(float, row), 21.5, 30.0, 255] for row in XYZV]
    content = {
        "cfg": ["sensorStop\n"],
        "demo": "x",
        "device": "xWR6843",
        "data": [one(3, rows), one(5, rows[:1]), one(6, [])],
    }
    (tmp_path / "replay_1.json").write_text(json.dumps(content))
    cloud = read_points(tmp_path / "replay_1.json")
    assert (cloud.frame.tolist(), cloud.num_frames) == ([0, 0, 0, 2], 4)
    assert np.allclose(np.column_stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps])[:3], XYZV)
    assert (cloud.snr_db == 21.5).all()
    (tmp_path / "replay_1.json").write_text(json.dumps({"data": [{"frameData": {"error": 0}}]}))
    with pytest.raises(InputError, match="no point cloud"):
        read_points(tmp_path / "replay_1.json")


def test_stacks_of_frames_filled_up_with_zeros(tmp_path: Path):
    stack = np.zeros((4, 8, 8, 5), np.float32)
    stack[0, 0, :3, :4], stack[0, 0, :3, 4] = XYZV, [1, 2, 3]
    stack[2, 5, 1] = (0.5, 1.5, 0.1, 0.2, 9)
    np.save(tmp_path / "featuremap_train.npy", stack)
    cloud = read_points(tmp_path / "featuremap_train.npy")
    assert (cloud.frame.tolist(), cloud.num_frames) == ([0, 0, 0, 2], 4)
    assert np.allclose(cloud.y_m, [*XYZV[:, 1], 1.5])
    assert cloud.intensity.tolist() == [1, 2, 3, 9]


@pytest.mark.parametrize(("scale", "unit"), [(1000.0, "mm"), (250.0, "cm")])
def test_other_units_are_noticed(tmp_path: Path, scale: float, unit: str):
    rows = "".join(f"{k},3,{0.3 * scale:g},{3.9 * scale:g},{0.5 * scale:g},0,13\n" for k in range(5))
    (tmp_path / "log.csv").write_text("Frame #,# Obj,X,Y,Z,Doppler,Intensity\n" + rows)
    cloud = read_points(tmp_path / "log.csv")
    assert any(f"as {unit}" in note for note in cloud.notes)
    factor = {"mm": 0.001, "cm": 0.01}[unit]
    assert np.allclose(cloud.y_m, 3.9 * scale * factor)
    assert np.allclose(read_points(tmp_path / "log.csv", unit="m").y_m, 3.9 * scale)


def test_columns_of_radar_scan_have_ros_axes(tmp_path: Path):
    head = "Frame,point_id,X,Y,Z,range,velocity,doppler_bin,bearing,intensity\n"
    (tmp_path / "ros.csv").write_text(head + "0,0,3.0,0.5,0.2,3.05,-0.4,3,9.46,20\n1,0,2.0,-0.5,0,2.06,0,0,-14.0,9\n")
    cloud = read_points(tmp_path / "ros.csv")
    assert cloud.x_m.tolist() == [-0.5, 0.5]
    assert cloud.y_m.tolist() == [3.0, 2.0]
    plain = "Frame,X,Y,Z,Doppler\n0,3.0,0.5,0.2,-0.4\n"
    (tmp_path / "plain.csv").write_text(plain)
    assert read_points(tmp_path / "plain.csv").x_m.tolist() == [3.0]
    assert read_points(tmp_path / "plain.csv", axes="ros").y_m.tolist() == [3.0]


def test_points_of_one_time_are_a_frame(tmp_path: Path):
    """A log without frame numbers, whose NumFrame counts the points of a frame."""
    rows = "1734208812351.2,1,0.09,0.87,0.68,-0.9\n1734208812351.2,2,0.10,0.84,0.69,-0.6\n"
    rows += "1734208812407.9,1,0.1,0.9,0.7,0\n"
    (tmp_path / "log.csv").write_text("Timestamp,NumFrame,X,Y,Z,Doppler\n" + rows)
    cloud = read_points(tmp_path / "log.csv")
    assert (cloud.frame.tolist(), cloud.num_frames) == ([0, 0, 1], 2)
    assert cloud.y_m.tolist() == [0.87, 0.84, 0.9]


def test_ros_bags_that_we_export_come_back(tmp_path: Path):
    """PointCloud2 in ROS's axes, by rosbags, whose writer is not ours."""
    pytest.importorskip("rosbags")
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    made = {name.split("/")[-1]: kind for name, kind in store.types.items()}
    field: Any = made["PointField"]
    names = ("x", "y", "z", "velocity", "intensity")
    with Writer(tmp_path / "bag", version=9) as bag:
        link = bag.add_connection("/ti_mmwave/cloud", "sensor_msgs/msg/PointCloud2", typestore=store)
        for number, count in enumerate((3, 0, 2)):
            rows = np.column_stack([XYZV[:count, 1], -XYZV[:count, 0], XYZV[:count, 2:], np.full(count, 7.0)])
            data = np.frombuffer(rows.astype("<f4").tobytes(), np.uint8)
            header = made["Header"](stamp=made["Time"](sec=number, nanosec=0), frame_id="ti_mmwave")
            message = made["PointCloud2"](
                header=header, height=1, width=count, is_bigendian=False, point_step=20, row_step=20 * count,
                fields=[field(name=n, offset=4 * k, datatype=field.FLOAT32, count=1) for k, n in enumerate(names)],
                data=data, is_dense=True,
            )  # fmt: skip
            bag.write(link, number * 10**9, store.serialize_cdr(message, "sensor_msgs/msg/PointCloud2"))
    cloud = read_points(tmp_path / "bag")
    assert (cloud.frame.tolist(), cloud.num_frames) == ([0, 0, 0, 2, 2], 3)
    assert np.allclose(np.column_stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps])[:3], XYZV)
    assert (cloud.intensity == 7).all()


@pytest.mark.skipif(not CASES.is_dir(), reason="the made cases are not here")
def test_made_cases():
    assert read_points(CASES / "uart_trailing_empty" / "empty.dat").num_frames == 20
    with pytest.raises(InputError, match="2, 1040"):
        read_points(CASES / "uart_no_points" / "vital.dat")
    ros = read_points(CASES / "csv_ros_axes" / "ros.csv")
    assert (set(ros.x_m.tolist()), set(ros.y_m.tolist())) == ({-0.5}, {3.0})
    replay = read_points(CASES / "ti_replay_json" / "replay_1.json")
    assert (len(replay.frame), replay.num_frames, set(replay.snr_db.tolist())) == (30, 10, {20.0})
