"""Good and bad input files."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.scene.read_photo import read_photo

CAMERA = {"fx": 80.0, "fy": 80.0, "cx": 47.5, "cy": 35.5}
DEPTH = np.full((72, 96), 2500, np.uint16)


class Files:
    """A folder with a good photo in it, to be spoilt."""

    def __init__(self, folder: Path):
        self.rgb, self.depth, self.camera = folder / "rgb.png", folder / "depth.png", folder / "camera.json"
        colours = np.random.default_rng(0).integers(0, 255, (72, 96, 3), dtype=np.uint8)
        Image.fromarray(colours).save(self.rgb)
        Image.fromarray(DEPTH).save(self.depth)
        self.set_camera(**CAMERA)

    def set_camera(self, **content: Any) -> None:
        self.camera.write_text(json.dumps(content))

    def set_npy(self, values: np.ndarray, **options: Any) -> None:
        self.depth = self.depth.with_suffix(".npy")
        np.save(self.depth, values, **options)

    def read(self):
        return read_photo(self.rgb, self.depth, self.camera)

    def error(self) -> str:
        with pytest.raises(InputError) as raised:
            self.read()
        assert "\n" not in str(raised.value)
        return str(raised.value)


@pytest.fixture
def files(tmp_path: Path) -> Files:
    return Files(tmp_path)


def test_a_good_photo(files: Files):
    photo, assumptions = files.read()
    assert photo.rgb.shape == (72, 96, 3)
    assert photo.depth_m[0, 0] == 2.5
    assert (photo.intrinsics.fx, photo.intrinsics.width) == (80.0, 96)
    assert len(assumptions) == 1
    assert "--depth-unit mm" in assumptions[0]  # how the unit was found is always reported


@pytest.mark.parametrize("values", [DEPTH, DEPTH.astype(np.int32), DEPTH / np.float32(1000), DEPTH / 1000.0, DEPTH * 5])
@pytest.mark.parametrize("suffix", [".npy", ".png", ".tiff"])
def test_depth_in_counts_or_metres(files: Files, values: np.ndarray, suffix: str):
    if values[0, 0] == 12500:
        files.set_camera(**CAMERA, depth_unit_m=0.0002)
    files.depth = files.depth.with_suffix(suffix)
    if suffix == ".npy":
        np.save(files.depth, values)
    elif values.dtype == np.uint16 or (suffix == ".tiff" and values.dtype.itemsize == 4):
        Image.fromarray(values).save(files.depth)
    else:
        pytest.skip("no picture of this format holds such values")
    assert files.read()[0].depth_m[3, 3] == pytest.approx(2.5)


def test_holes_become_nan(files: Files):
    depth = DEPTH.copy()
    depth[:10], depth[10:12] = 0, 65535
    Image.fromarray(depth).save(files.depth)
    photo, _ = files.read()
    assert np.isnan(photo.depth_m[:12]).all()
    assert np.isfinite(photo.depth_m[12:]).all()
    values = DEPTH / 1000.0
    values[0, :4] = [np.nan, np.inf, -1, 0]
    files.set_npy(values)
    assert np.isnan(files.read()[0].depth_m[0]).sum() == 4


@pytest.mark.parametrize("mode", ["L", "RGBA", "P", "CMYK", "LA", "I;16"])
def test_all_kinds_of_colour_become_rgb(files: Files, mode: str):
    if mode == "I;16":
        Image.fromarray(np.full((72, 96), 32768, np.uint16)).save(files.rgb)
    else:
        files.rgb = files.rgb.with_suffix(".tiff") if mode == "CMYK" else files.rgb
        Image.new("RGB", (96, 72), (200, 30, 90)).convert(mode).save(files.rgb)
    photo, _ = files.read()
    assert photo.rgb.dtype == np.uint8
    expected = {"L": (88, 88, 88), "LA": (88, 88, 88), "I;16": (128, 128, 128)}.get(mode, (200, 30, 90))
    np.testing.assert_allclose(photo.rgb[5, 5], expected, atol=26 if mode == "P" else 3)


@pytest.mark.parametrize("orientation", [5, 6, 7, 8])
@pytest.mark.parametrize("kind", [".jpg", ".heic"])
def test_depth_that_lies_as_the_colours_did_is_turned_with_them(files: Files, orientation: int, kind: str):
    if kind == ".heic":
        pytest.importorskip("pillow_heif").register_heif_opener()
    exif = Image.Exif()
    exif[0x0112] = orientation
    files.rgb = files.rgb.with_suffix(kind)
    stored = np.full((72, 96), 60, np.uint8)
    stored[:24, :32] = 250  # in one corner
    Image.fromarray(stored).convert("RGB").save(files.rgb, exif=exif.tobytes(), quality=95)
    Image.fromarray(stored.astype(np.uint16) * 20).save(files.depth)
    photo, assumptions = files.read()
    assert photo.rgb.shape[:2] == photo.depth_m.shape == (96, 72)
    np.testing.assert_array_equal(photo.depth_m > 3, photo.rgb[..., 1] > 150)
    assert "turned with it" in " ".join(assumptions)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros((72, 96), np.uint16), "every depth value"),
        (np.full((72, 96), 25000, np.uint16), "--depth-unit"),
        (np.full((72, 96), 120, np.uint8), "8 bits"),
        (np.where(np.arange(96) < 5, DEPTH, 0).astype(np.uint16), "5.2 %"),
        (np.full((70, 96), 2500, np.uint16), "aligned"),
        (np.full((72, 96), np.nan), "every depth value"),
        (np.full((72, 96), -2.0), "every depth value"),
        (np.full((72, 96), 2500.0), "multiply it by 0.001"),
        (np.full((72, 96, 1), 2.0), "shape"),
        (np.full((72, 96), 2 + 0j), "complex128"),
        (np.full((3, 3), 2.0), "3 x 3"),
        (np.full((72, 96), True), "bool"),
    ],
)
def test_what_cannot_be_depth_is_refused(files: Files, values: np.ndarray, message: str):
    if values.dtype == np.uint16:
        Image.fromarray(values).save(files.depth)
    else:
        files.set_npy(values)
    assert message in files.error()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fx": None}, "fx is None"),
        ({"fx": float("nan")}, "it holds NaN"),
        ({"fx": -80}, "positive"),
        ({"fx": 0}, "positive"),
        ({"fy": "80"}, "finite number"),
        ({"cx": True}, "finite number"),
        ({"fx": 5e9}, "0.001 to 1e+06"),
        ({"cx": 900}, "principal point"),
        ({"cy": -300}, "principal point"),
        ({"fx": 0.08, "fy": 0.08}, "view of"),
        ({"fx": 8000, "fy": 8000}, "view of"),
        ({"fx": 80, "fy": 8}, "view of"),
        ({"width": 640, "height": 640}, "another aspect ratio"),
        ({"depth_unit_m": 0}, "positive"),
        ({"depth_unit_m": float("inf")}, "it holds Infinity"),
    ],
)
def test_bad_camera_files(files: Files, change: dict[str, Any], message: str):
    files.set_camera(**{**CAMERA, **change})
    assert message in files.error()


# sizes, depths and formats of other cameras ----------------------------------------------------------------------
def test_a_coarse_depth_picture_is_enlarged_by_whole_pixels(files: Files):
    """As on phones: the colour picture is several times as large."""
    ramp = (1500 + 10 * np.arange(96)[None, :] + np.zeros((72, 1))).astype(np.uint16)
    Image.fromarray(ramp).save(files.depth)
    Image.new("RGB", (960, 720), (10, 200, 30)).save(files.rgb)
    files.set_camera(fx=800.0, fy=800.0, cx=479.5, cy=359.5)
    photo, assumptions = files.read()
    assert photo.rgb.shape == (504, 672, 3)
    assert photo.depth_m.shape == (504, 672)
    assert np.unique(photo.depth_m) == pytest.approx(ramp[0] / 1000)
    assert photo.intrinsics.fx == pytest.approx(560.0)
    assert photo.intrinsics.cx == pytest.approx(335.5)
    assert "960 x 720" in assumptions[0]
    assert "96 x 72" in assumptions[0]


def _exif(focal_mm: float) -> Image.Exif:
    exif = Image.Exif()
    exif.get_ifd(0x8769)[0xA405] = focal_mm  # FocalLengthIn35mmFilm
    return exif


def test_the_focal_length_of_a_phone_is_taken(tmp_path: Path):
    rgb = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    Image.fromarray(rgb).save(tmp_path / "phone.jpg", exif=_exif(26))
    np.save(tmp_path / "depth.npy", np.full((480, 640), 2.0))
    photo, notes = read_photo(tmp_path / "phone.jpg", tmp_path / "depth.npy")
    assert photo.intrinsics.fx == pytest.approx(26 * 800 / np.hypot(36, 24))
    assert any("26 mm on 35 mm film" in note for note in notes)
    Image.fromarray(rgb).save(tmp_path / "odd.jpg", exif=_exif(0))
    photo, notes = read_photo(tmp_path / "odd.jpg", tmp_path / "depth.npy")
    assert photo.intrinsics.fx == 384.0
    assert any("D455" in note for note in notes)


def test_heic_is_read(tmp_path: Path):
    heif = pytest.importorskip("pillow_heif")
    heif.register_heif_opener()
    rgb = np.zeros((480, 640, 3), np.uint8)
    rgb[:, :320] = 200
    Image.fromarray(rgb).save(tmp_path / "phone.heic", exif=_exif(26), quality=90)
    np.save(tmp_path / "depth.npy", np.full((480, 640), 2.0))
    photo, _ = read_photo(tmp_path / "phone.heic", tmp_path / "depth.npy")
    assert np.abs(photo.rgb[:, 40:280].astype(int) - 200).mean() < 5
    assert photo.intrinsics.fx == pytest.approx(26 * 800 / np.hypot(36, 24))
    content = (tmp_path / "phone.heic").read_bytes()
    (tmp_path / "cut.heic").write_bytes(content[: len(content) // 2])
    with pytest.raises(InputError):
        read_photo(tmp_path / "cut.heic", tmp_path / "depth.npy")
