"""Scans of phones and data sets: each writes the sample room as its app does, sensors turned by quarters."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import resized, rotated_clockwise
from mmweaver.core.records import RgbdPhoto
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.scan_folders import FORMATS, read_scan_photo, scan_kind, scan_pose
from mmweaver.weaver.front_door import Weaver

SIZE = (320, 240)
# rotations of a camera (x right, y down) into a world with y up, as x, y, z, w: upright, and up to the picture's right
QUATERNIONS = ((1.0, 0.0, 0.0, 0.0), (0.70710678, 0.70710678, 0.0, 0.0))


def lying(clockwise: int) -> tuple[np.ndarray, np.ndarray, tuple[float, float, float, float]]:
    """The sample photo at SIZE, rotated clockwise so many quarters: colours, depth in metres, and fx, fy, cx, cy."""
    photo, _ = sample_photo()
    camera, step = resized(photo.intrinsics, *SIZE), photo.rgb.shape[1] // SIZE[0]
    rgb = np.array(Image.fromarray(photo.rgb).resize(SIZE, Image.Resampling.BOX))
    depth_m = np.nan_to_num(photo.depth_m[::step, ::step])
    for _ in range(clockwise):
        camera = rotated_clockwise(camera)
    turned = np.rot90(rgb, -clockwise).copy(), np.rot90(depth_m, -clockwise).copy()
    return *turned, (camera.fx, camera.fy, camera.cx, camera.cy)


def save(path: Path, values: np.ndarray, unit_m: float | None = None) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(values if unit_m is None else np.round(values / unit_m).astype(np.uint16)).save(path, quality=95)


def stray(folder: Path, clockwise: int = 0) -> None:
    av = pytest.importorskip("av")
    rgb, depth_m, (fx, fy, cx, cy) = lying(clockwise)
    save(folder / "depth" / "000000.png", depth_m, 0.001)
    with av.open(str(folder / "rgb.mp4"), "w") as video:
        stream = video.add_stream("libx264", rate=30, options={"crf": "4"})
        stream.height, stream.width = rgb.shape[:2]
        stream.pix_fmt = "yuv444p"
        video.mux(stream.encode(av.VideoFrame.from_ndarray(rgb, format="rgb24")))
        video.mux(stream.encode())
    (folder / "camera_matrix.csv").write_text(f"{fx}, 0.0, {cx}\n0.0, {fy}, {cy}\n0.0, 0.0, 1.0\n")
    numbers = ", ".join(map(str, QUATERNIONS[clockwise]))
    (folder / "odometry.csv").write_text(
        "timestamp, frame, x, y, z, qx, qy, qz, qw, fx, fy, cx, cy, distortion_center_x, distortion_center_y\n"
        f"0.1, 000000, 0, 0, 0, {numbers}, {fx}, {fy}, {cx}, {cy}, , \n"
    )


def polycam(folder: Path, clockwise: int = 0) -> None:
    rgb, depth_m, (fx, fy, cx, cy) = lying(clockwise)
    save(folder / "keyframes" / "images" / "100.jpg", rgb)
    save(folder / "keyframes" / "depth" / "100.png", depth_m, 0.001)
    turn = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]])[clockwise]  # up lies to the right
    up = {f"t_{i}{j}": float([*turn[i], 0][j]) for i in range(3) for j in range(4)}
    place = folder / "keyframes" / "cameras" / "100.json"
    place.parent.mkdir()
    place.write_text(json.dumps({"fx": fx, "fy": fy, "cx": cx, "cy": cy, **up}))


def record3d(folder: Path, clockwise: int = 0) -> None:
    """An unpacked .r3d, its depth in stored blocks of LZFSE; poses are of ARKit's camera (x right, y up)."""
    rgb, depth_m, (fx, fy, cx, cy) = lying(clockwise)
    save(folder / "rgbd" / "0.jpg", rgb)
    raw = depth_m.astype("<f4").tobytes()
    blocks = [raw[:1000], raw[1000:]]
    stored = b"".join(b"bvx-" + len(one).to_bytes(4, "little") + one for one in blocks) + b"bvx$"
    (folder / "rgbd" / "0.depth").write_bytes(stored)
    size = {"w": rgb.shape[1], "h": rgb.shape[0], "dw": depth_m.shape[1], "dh": depth_m.shape[0]}
    turned = ([0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.70710678, 0.70710678])[clockwise]  # x, y, z, w
    more = {"poses": [[*turned, 0.0, 0.0, 0.0]], "perFrameIntrinsicCoeffs": [[fx, fy, cx, cy]], "fps": 60}
    (folder / "metadata").write_text(json.dumps({**size, "K": [fx + 9, 0, 0, 0, fy + 9, 0, cx, cy, 1], **more}))
    put_confidence(folder, np.full(depth_m.shape, 2, np.uint8))


def put_confidence(folder: Path, confidence: np.ndarray) -> None:
    raw = confidence.tobytes()
    (folder / "rgbd" / "0.conf").write_bytes(b"bvx-" + len(raw).to_bytes(4, "little") + raw + b"bvx$")


def scannet(folder: Path, clockwise: int = 0) -> None:
    rgb, depth_m, (fx, fy, cx, cy) = lying(clockwise)
    save(folder / "color" / "0.jpg", rgb)
    save(folder / "depth" / "0.png", depth_m, 0.001)
    pose = ("1 0 0 0\n0 0 1 0\n0 -1 0 0\n0 0 0 1\n", "0 1 0 0\n0 0 1 0\n1 0 0 0\n0 0 0 1\n")[clockwise]
    matrix = f"{fx} 0 {cx} 0\n0 {fy} {cy} 0\n0 0 1 0\n0 0 0 1\n"
    for name, text in (("intrinsic/intrinsic_color.txt", matrix), ("pose/0.txt", pose)):
        (folder / name).parent.mkdir()
        (folder / name).write_text(text)


def tum(folder: Path) -> None:
    rgb, depth_m, _ = lying(0)
    save(folder / "rgb" / "1305031102.175304.png", rgb)
    save(folder / "depth" / "1305031102.160407.png", depth_m, 0.0002)


def seven_scenes(folder: Path) -> None:
    rgb, depth_m, _ = lying(0)
    save(folder / "frame-000000.color.png", rgb)
    save(folder / "frame-000000.depth.png", np.where(depth_m > 0, depth_m, 65.535), 0.001)
    (folder / "frame-000000.pose.txt").write_text("1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")


def replica(folder: Path) -> None:
    rgb, depth_m, (fx, fy, cx, cy) = lying(0)
    save(folder / "results" / "frame000000.jpg", rgb)
    save(folder / "results" / "depth000000.png", depth_m, 1 / 6553.5)
    (folder / "traj.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n")
    camera = {"w": SIZE[0], "h": SIZE[1], "fx": fx, "fy": fy, "cx": cx, "cy": cy, "scale": 6553.5}
    (folder / "cam_params.json").write_text(json.dumps({"camera": camera}))


def sun_rgbd(folder: Path) -> None:
    rgb, depth_m, (fx, fy, cx, cy) = lying(0)
    save(folder / "image" / "0000001.jpg", rgb)
    millimetres = np.round(1000 * depth_m).astype(np.uint16)
    save(folder / "depth_bfx" / "0000001.png", (millimetres << 3) | (millimetres >> 13))
    (folder / "intrinsics.txt").write_text(f"{fx} 0 {cx}\n0 {fy} {cy}\n0 0 1\n")


def icl_nuim(folder: Path) -> None:
    rgb, depth_m, _ = lying(0)
    save(folder / "rgb" / "0.png", rgb)
    save(folder / "depth" / "0.png", depth_m, 0.0002)


def redwood(folder: Path) -> None:
    rgb, depth_m, _ = lying(0)
    save(folder / "rgb" / "00000.jpg", rgb)
    save(folder / "depth" / "00000.png", depth_m, 0.001)
    (folder / "odometry.log").write_text("0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")


@pytest.mark.parametrize(
    ("write", "kind", "has_pose"),
    [
        (seven_scenes, "7-Scenes", True),
        (replica, "Replica", True),
        (sun_rgbd, "SUN RGB-D", False),
        (icl_nuim, "ICL-NUIM", False),
        (redwood, "Redwood", True),
        (tum, "TUM RGB-D", False),
    ],
)
def test_folders_of_data_sets_have_their_own_units(
    write: Callable[[Path], None], kind: str, has_pose: bool, tmp_path: Path
):
    write(tmp_path)
    assert scan_kind(tmp_path) == kind
    found = read_scan_photo(tmp_path)
    assert_same_depth(found.photo, lying(0)[1])
    picture = next(iter(sorted(tmp_path.glob(FORMATS[kind].pictures[0]))))
    assert (scan_pose(tmp_path, kind, picture) is not None) == has_pose


def assert_same_depth(found: RgbdPhoto, depth_m: np.ndarray) -> None:
    step = found.depth_m.shape[0] // depth_m.shape[0]
    assert np.nanmedian(np.abs(found.depth_m[::step, ::step] - depth_m)[depth_m > 0]) < 0.002


@pytest.mark.parametrize("clockwise", [0, 1])
@pytest.mark.parametrize("write", [stray, polycam, scannet, record3d])
def test_a_scan_is_the_upright_photo(write: Callable[[Path, int], None], clockwise: int, tmp_path: Path):
    write(tmp_path, clockwise)
    rgb, depth_m, numbers = lying(0)
    found = read_scan_photo(tmp_path).photo
    camera = resized(found.intrinsics, *SIZE)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == pytest.approx(numbers, abs=0.01)
    assert_same_depth(found, depth_m)
    step = found.rgb.shape[0] // rgb.shape[0]
    assert np.abs(found.rgb[::step, ::step].astype(int) - rgb).mean() < 8


@pytest.mark.parametrize("write", [stray, polycam, record3d])
def test_depth_of_the_lowest_confidence_is_left_out(write: Callable[[Path, int], None], tmp_path: Path):
    write(tmp_path, 0)
    whole = read_scan_photo(tmp_path)
    confidence = np.full(SIZE[::-1], 255 if write is polycam else 2, np.uint8)
    confidence[:, :120] = 0
    if write is record3d:
        put_confidence(tmp_path, confidence)
    else:
        save(tmp_path / ("keyframes" if write is polycam else ".") / "confidence"
             / ("100.png" if write is polycam else "000000.png"), confidence)  # fmt: skip
    found = read_scan_photo(tmp_path)
    width = found.photo.depth_m.shape[1]
    assert np.isnan(found.photo.depth_m[:, : width * 110 // 320]).all()
    right = slice(width * 130 // 320, None)  # single missing pixels are filled only where few are
    left, before = found.photo.depth_m[:, right], whole.photo.depth_m[:, right]
    assert np.isfinite(left).sum() > 0.95 * np.isfinite(before).sum()
    both = np.isfinite(left) & np.isfinite(before)
    np.testing.assert_array_equal(left[both], before[both])
    assert "lowest confidence" in " ".join(found.assumptions)


def test_tum_has_its_unit_and_camera(tmp_path: Path):
    tum(tmp_path / "rgbd_dataset_freiburg1_room")
    read = read_scan_photo(tmp_path / "rgbd_dataset_freiburg1_room")
    assert_same_depth(read.photo, lying(0)[1])
    assert resized(read.photo.intrinsics, 640, 480).fx == pytest.approx(517.3, abs=0.1)
    assert "freiburg1" in " ".join(read.assumptions)


def test_a_room_is_opened_whatever_it_is(tmp_path: Path):
    """One photo of a scan, the same as views.json, and the same as plain files."""
    polycam(tmp_path / "scan", 0)
    weaver = Weaver()
    scan = weaver.open_room(tmp_path / "scan")
    photo, plain = scan.scene.photo, tmp_path / "plain"
    save(plain / "rgb.png", photo.rgb)
    save(plain / "depth.png", np.nan_to_num(photo.depth_m), 0.001)
    camera = {name: getattr(photo.intrinsics, name) for name in ("fx", "fy", "cx", "cy", "width", "height")}
    (plain / "camera.json").write_text(json.dumps(camera))
    named = {"rgb": "rgb.png", "depth": "depth.png", "camera": "camera.json"}
    (tmp_path / "views").mkdir()
    views = {"photos": [{name: f"../plain/{file}" for name, file in named.items()}]}
    (tmp_path / "views" / "views.json").write_text(json.dumps(views))
    for place in (plain, tmp_path / "views", tmp_path / "views" / "views.json"):
        assert weaver.open_room(place).scene.floor_z_m == pytest.approx(scan.scene.floor_z_m, abs=0.005)
    with pytest.raises(InputError, match=r"rgb\.png"):
        weaver.open_room(tmp_path)


def test_others_are_refused_in_one_line(tmp_path: Path):
    assert scan_kind(tmp_path) is None
    with pytest.raises(InputError, match="no scan of"):
        read_scan_photo(tmp_path)
    polycam(tmp_path / "p")
    with pytest.raises(InputError, match=r"1 pictures.*3"):
        read_scan_photo(tmp_path / "p", 3)
    (tmp_path / "p" / "keyframes" / "cameras" / "100.json").write_text('{"fx": 1}')
    with pytest.raises(InputError, match="lacks fx"):
        read_scan_photo(tmp_path / "p")
    scannet(tmp_path / "s")
    (tmp_path / "s" / "pose" / "0.txt").write_text("a b")
    with pytest.raises(InputError, match=r"0\.txt"):
        read_scan_photo(tmp_path / "s")
    tum(tmp_path / "t")
    (tmp_path / "t" / "depth" / "1305031102.160407.png").rename(tmp_path / "t" / "depth" / "1305031109.png")
    with pytest.raises(InputError, match=r"30 ms.*1305031102"):
        read_scan_photo(tmp_path / "t")
