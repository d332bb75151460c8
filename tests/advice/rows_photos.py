"""Advice about photos, scans and models of depth; the models are small functions of the models' interface."""

import shutil
from pathlib import Path

import numpy as np
from PIL import Image

from mmweaver.core.records import CameraIntrinsics
from tests.advice.harness import Row, add, instead
from tests.captures import write_camera
from tests.scene.test_scan_folders import scannet

SHORT = "--text 'a person waves' --frames 1 --no-pictures --out out"


ESTIMATED = f"generate --rgb {{rgb}} --camera {{camera}} {SHORT}"
CAPTURE = f"generate --room capture {SHORT}"
LENS = CameraIntrinsics(fx=60.0, fy=60.0, cx=31.5, cy=23.5, width=64, height=48)


def _capture(depths_m: tuple[float, ...] = (2.0, 3.0)) -> None:
    picture = np.full((96, 128, 3), 90, np.uint8)
    Path("capture").mkdir()
    write_camera(
        Path("capture/realsense"), LENS, [np.full((48, 64), depth) for depth in depths_m], [picture] * len(depths_m)
    )


def _capture_without_video() -> None:
    _capture()
    Path("capture/realsense/color.avi").write_bytes(b"no video")
    Image.new("RGB", (128, 96)).save("own.png")


def _scan_without_first_pose() -> None:
    folder = Path("scan")
    scannet(folder)
    for name in ("color/0.jpg", "depth/0.png", "pose/0.txt"):
        shutil.copy(folder / name, folder / name.replace("0.", "1."))
    (folder / "pose/0.txt").write_text("-inf -inf -inf -inf\n" * 4)


ROWS = tuple(
    Row(text, command, tries, before, reads_photo=True)
    for text, command, tries, before in (
        (
            "□: photo □ has no depth at all; choose another (--photo)",
            CAPTURE,
            (add("--photo", "1"),),
            lambda: _capture((0.0, 3.0)),
        ),
        (
            "□: photo □ has no pose, by which",
            f"generate --room scan --extra-views auto {SHORT}",
            (add("--photo", "1"),),
            _scan_without_first_pose,
        ),
        ("is it whole? or give the picture", CAPTURE, (add("--rgb", "own.png"),), _capture_without_video),
        (
            "--depth □ gives no depth for this picture",
            f"{ESTIMATED} --depth blind",
            (instead("try another model", "blind", "metric"),),
            lambda: None,
        ),
        (
            "--depth □ cannot process this picture",
            f"{ESTIMATED} --depth broken",
            (instead("try another model", "broken", "metric"),),
            lambda: None,
        ),
    )
)
