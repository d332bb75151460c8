"""Point clouds of boards and data sets come back with their places, from files written here by their description."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.io.npz_files import read_points_npz
from mmweaver.io.point_clouds.read_points import points_kind, read_points
from mmweaver.io.point_clouds.ti_uart import MAGIC, read_ti_uart

XYZV = np.array([[0.5, 2.0, 0.1, -0.4], [-1.0, 3.5, -0.6, 0.8], [0.0, 1.0, 0.0, 0.0]], np.float32)


def packet(
    number: int, tlvs: list[tuple[int, bytes]], objects: int, version: int = 0x03050004, platform: int = 0xA6843
) -> bytes:
    """A packet of a demo's data port, padded to 32 bytes as the firmware does."""
    body = b"".join(struct.pack("<II", kind, len(data)) + data for kind, data in tlvs)
    tail = b"" if platform & 0xFFFF == 0x1443 else struct.pack("<I", 0)  # the sub-frame's number
    length = 36 + len(tail) + len(body)
    padded = -(-length // 32) * 32
    head = struct.pack("<8sIIIIIII", MAGIC, version, padded, platform, number, 12345, objects, len(tlvs))
    return head + tail + body + bytes(padded - length)


def out_of_box(number: int, points: np.ndarray) -> bytes:
    side = np.array([[123, 400]] * len(points), "<i2").tobytes()
    return packet(number, [(1, points.astype("<f4").tobytes()), (7, side), (2, bytes(512))], len(points))


def test_the_out_of_box_demo(tmp_path: Path):
    """Noise before the first packet, an empty frame, a damaged packet, a cut last one."""
    damaged = bytearray(out_of_box(8, XYZV))
    damaged[12:16] = struct.pack("<I", 1 << 30)
    log = b"garbage" + out_of_box(7, XYZV) + bytes(damaged) + out_of_box(9, XYZV[:0]) + out_of_box(10, XYZV[:1])
    (tmp_path / "log.dat").write_bytes(log + out_of_box(11, XYZV)[:50])
    found = read_ti_uart(tmp_path / "log.dat")
    assert found.frame_number.tolist() == [7, 9, 10]
    assert found.skipped == 2
    cloud = read_points(tmp_path / "log.dat")
    assert cloud.frame.tolist() == [0, 0, 0, 3]  # the board counted frame 8, too
    assert cloud.num_frames == 4
    assert any("1 of 4 frames" in note for note in cloud.notes)
    assert any("2 damaged" in note for note in cloud.notes)
    assert np.allclose(np.column_stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps])[:3], XYZV)
    assert np.allclose(cloud.snr_db, 12.3)


@pytest.mark.parametrize(
    ("version", "platform"),
    [(0x01010005, 0xA1443), (0x02000004, 0xA1443), (0x01020005, 0xA1642), (0x02010004, 0xA1642)],
)
def test_the_first_sdks_write_integers(tmp_path: Path, version: int, platform: int):
    """SDK 1 and 2; an xWR1443's header has no sub-frame number. An empty frame has no points at all."""
    rows = np.array([[10, 3, 900, 256, 1024, -128], [20, -3, 40000 - 65536, -256, 512, 0]], "<i2")
    data = struct.pack("<HH", 2, 9) + rows.tobytes()
    log = packet(1, [(1, data), (2, bytes(512))], 2, version, platform) + packet(2, [], 0, version, platform)
    (tmp_path / "log.dat").write_bytes(log)
    found = read_ti_uart(tmp_path / "log.dat")
    assert (found.frame_number.tolist(), found.skipped) == ([1, 2], 0)
    cloud = found.points
    assert (cloud.x_m[0], cloud.y_m[0], cloud.z_m[0], cloud.intensity.tolist()) == (0.5, 2.0, -0.25, [900, 40000])
    assert np.isnan(cloud.radial_velocity_mps).all()


def test_low_power_devices_compress_points(tmp_path: Path):
    """TLV 301: units, counts of large and small movements, then places, velocity, SNR and noise of each point."""
    units = struct.pack("<4f2H", 0.001, 0.002, 0.25, 0.25, 1, 1)
    points = struct.pack("<4h2B", -500, 2000, 100, -200, 80, 20) + struct.pack("<4h2B", 0, 1000, 0, 50, 40, 20)
    (tmp_path / "log.dat").write_bytes(packet(3, [(301, units + points)], 2, 0x05050004, 0xA6432))
    cloud = read_points(tmp_path / "log.dat")
    assert np.allclose(np.column_stack([cloud.x_m, cloud.y_m, cloud.z_m]), [[-0.5, 2, 0.1], [0, 1, 0]])
    assert (cloud.radial_velocity_mps.tolist(), cloud.snr_db.tolist()) == (pytest.approx([-0.4, 0.1]), [20.0, 10.0])


def test_people_counting_counts_its_own_headers(tmp_path: Path):
    """The predecessor of 3D People Tracking: a header of 48 bytes, TLVs 6 (points) and 8 (whose they are)."""
    units = struct.pack("<5f", 0.01, 0.01, 0.05, 0.002, 0.04)
    points = struct.pack("<bbhHH", 10, -20, 8, 1000, 500)
    tlvs = [(6, units + points), (8, bytes([253]))]
    body = b"".join(struct.pack("<II", kind, len(data) + 8) + data for kind, data in tlvs)
    head = struct.pack("<8s9I2H", MAGIC, 0x03040006, 48 + len(body), 0xA6843, 77, 0, 9, 8, 7, 6, len(tlvs), 0)
    (tmp_path / "log.dat").write_bytes(head + body)
    found = read_ti_uart(tmp_path / "log.dat")
    assert found.frame_number.tolist() == [77]
    place = [found.points.x_m[0], found.points.y_m[0], found.points.z_m[0]]
    assert np.linalg.norm(place) == pytest.approx(2.0)
    assert (np.arctan2(place[0], place[1]), np.arcsin(place[2] / 2)) == pytest.approx((-0.2, 0.1))


def test_people_tracking_has_compressed_points(tmp_path: Path):
    units = struct.pack("<5f", 0.01, 0.01, 0.05, 0.002, 0.04)
    points = b"".join(struct.pack("<bbhHH", *row) for row in [(10, -20, 8, 1000, 500), (0, 0, -4, 500, 250)])
    target = struct.pack("<I", 5) + struct.pack("<27f", *range(27))
    (tmp_path / "log.dat").write_bytes(packet(4, [(1020, units + points), (1010, target)], 2))
    found = read_ti_uart(tmp_path / "log.dat")
    cloud = found.points
    assert np.hypot(np.hypot(cloud.x_m, cloud.y_m), cloud.z_m) == pytest.approx([2.0, 1.0])
    assert np.arctan2(cloud.x_m, cloud.y_m) == pytest.approx([-0.2, 0.0], abs=1e-6)
    assert np.arcsin(cloud.z_m[0] / 2.0) == pytest.approx(0.1)
    assert cloud.radial_velocity_mps == pytest.approx([0.4, -0.2])
    assert cloud.snr_db == pytest.approx(10 * np.log10([20, 10]))
    assert found.tracks.number.tolist() == [5]
    assert found.tracks.place_m.tolist() == [[0, 1, 2]]
    assert found.tracks.velocity_mps.tolist() == [[3, 4, 5]]


def test_float_spherical_points_are_read(tmp_path: Path):
    points = struct.pack("<4f", 2.0, 0.5, 0.25, -0.75)
    (tmp_path / "log.dat").write_bytes(packet(4, [(1000, points), (7, struct.pack("<2h", 173, 360))], 1))
    found = read_ti_uart(tmp_path / "log.dat").points
    expected = [2 * np.cos(0.25) * np.sin(0.5), 2 * np.cos(0.25) * np.cos(0.5), 2 * np.sin(0.25)]
    assert found.xyz_m[0] == pytest.approx(expected)
    assert (found.radial_velocity_mps[0], found.snr_db[0]) == pytest.approx((-0.75, 17.3))


@pytest.mark.parametrize("kind", [1010, 308])
def test_a_log_of_targets_alone_is_a_recording_of_its_targets(tmp_path: Path, kind: int):
    targets = [struct.pack("<I27f", 3, 3.0, 4.0, 0.0, 0.6, 0.8, 0.0, *[0.0] * 21) for _ in range(2)]
    packets = [packet(7, [(kind, targets[0])], 0), packet(9, [(kind, targets[0] + targets[1])], 0)]
    (tmp_path / "log.dat").write_bytes(b"".join(packets))
    found = read_ti_uart(tmp_path / "log.dat").points
    assert found.frame.tolist() == [0, 2, 2]
    assert found.missing is not None
    assert found.missing.tolist() == [1]
    assert found.y_m.tolist() == [4.0] * 3
    assert found.radial_velocity_mps == pytest.approx([1.0] * 3)  # 0.6 * 0.6 + 0.8 * 0.8, away
    assert "targets" in found.notes[-1]


def test_csv_logs(tmp_path: Path):
    text = "Frame #,# Obj,X,Y,Z,Doppler,Intensity\n926,2,0.3,1.8,0.5,0,13\n926,2,0.4,1.9,0.6,-0.5,18\n928,1,0,2,0,1,7\n"
    (tmp_path / "log.csv").write_text(text)
    cloud = read_points(tmp_path / "log.csv")
    assert cloud.frame.tolist() == [0, 0, 2]
    assert cloud.y_m.tolist() == [1.8, 1.9, 2.0]
    assert cloud.radial_velocity_mps.tolist() == [0.0, -0.5, 1.0]
    assert cloud.intensity.tolist() == [13, 18, 7]
    assert np.isnan(cloud.snr_db).all()


def test_frames_of_mm_fi(tmp_path: Path):
    for number, rows in ((1, 2), (2, 0), (10, 1)):
        table = np.column_stack([XYZV, [5.0, 6.0, 7.0]])[:rows]
        table.astype("<f8").tofile(tmp_path / f"frame{number:03d}_mmwave.bin")
    cloud = read_points(tmp_path)
    assert cloud.frame.tolist() == [0, 0, 2]
    assert np.allclose(cloud.x_m, [0.5, -1.0, 0.5])
    assert cloud.intensity.tolist() == [5, 6, 5]


def test_text_and_archives_of_radhar_and_mhomeges(tmp_path: Path):
    """RadHAR has x ahead and y to the left."""
    text = "".join(
        f"header: \n  seq: 1\npoint_id: {index % 2}\nx: {2 + index}\ny: 0.5\nz: -0.1\nrange: 2\nvelocity: -0.3\n"
        "intensity: 9\n---\n"
        for index in range(4)
    )
    (tmp_path / "walk.txt").write_text(text)
    cloud = read_points(tmp_path / "walk.txt")
    assert cloud.frame.tolist() == [0, 0, 1, 1]
    assert (cloud.x_m[0], cloud.y_m[0]) == (-0.5, 2.0)
    assert cloud.intensity[0] == 9
    np.savez(tmp_path / "home.npz", frame=np.array([3, 3, 5]), pts=np.column_stack([XYZV, [1, 2, 3]]))
    cloud = read_points(tmp_path / "home.npz")
    assert cloud.frame.tolist() == [0, 0, 2]
    assert np.allclose(cloud.y_m, XYZV[:, 1])
    eight = np.zeros((2, 8))
    eight[:, :3], eight[:, 4] = [2.0, 0.5, -0.1], -0.3
    np.savez(tmp_path / "radhar.npz", t=np.zeros(2), frame=np.array([0, 1]), pts=eight)
    assert read_points(tmp_path / "radhar.npz").x_m.tolist() == [-0.5, -0.5]


def test_the_command_writes_points_npz(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "log.dat").write_bytes(out_of_box(7, XYZV))
    words = ["points", str(tmp_path / "log.dat"), "-o", str(tmp_path / "points.npz")]
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["points"] == 3
    assert np.allclose(read_points_npz(tmp_path / "points.npz").x_m, XYZV[:, 0])
    assert points_kind(tmp_path / "points.npz") == "points"
    assert len(read_points(tmp_path / "points.npz").frame) == 3
    assert main(words) == 2
    assert "--overwrite" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("log.dat", b"nothing here" * 20, "no point cloud"),
        ("log.csv", b"a,b\n1,2\n", "frame is missing"),
        ("log.csv", b"Frame,X,Y,Z,Doppler\n1,2,3,4,?\n", "not a number"),
        ("frame.bin", np.full(10, np.nan).tobytes(), "MM-Fi"),
        ("walk.txt", b"point_id: 0\nx: 1\n", "RadHAR"),
    ],
)
def test_what_is_none_is_refused(tmp_path: Path, name: str, content: bytes, says: str):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=says):
        read_points(tmp_path / name)


def test_public_recordings(real_data: Path):
    """MARS: a person two metres away, standing 1.5 to 2 m over the floor of a lab."""
    cloud = read_points(real_data / "pointclouds" / "mars" / "subject1" / "radar_data_test.csv")
    assert np.median(cloud.y_m) == pytest.approx(1.9, abs=0.3)
    assert cloud.frame.max() > 200
    home = read_points(next((real_data / "pointclouds" / "mhomeges").glob("*_1.5m_*.npz")))
    assert np.median(home.y_m) == pytest.approx(1.5, abs=0.5)
