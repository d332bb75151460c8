"""Pictures: a few decoders alone, upright, of a bounded size, without a word on stderr."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files import safe_pictures
from mmweaver.core.safe_files.safe_pictures import open_picture, read_animation

PIXELS = np.random.default_rng(0).integers(0, 255, (40, 60, 3), dtype=np.uint8)


@pytest.mark.parametrize("kind", ["PNG", "TIFF", "BMP", "PPM"])
def test_lossless_kinds_come_back_whatever_the_file_is_called(tmp_path: Path, kind: str):
    Image.fromarray(PIXELS).save(tmp_path / "a.jpg", kind)
    found = open_picture(tmp_path / "a.jpg")
    assert np.array_equal(np.asarray(found.image), PIXELS)
    assert found.stored_size == (60, 40)
    assert found.orientation == 1


@pytest.mark.parametrize("kind", ["EPS", "GIF", "DDS", "TGA", "ICO", "PDF"])
def test_other_decoders_are_out_of_reach(tmp_path: Path, kind: str):
    Image.fromarray(PIXELS).save(tmp_path / "a.png", kind)
    with pytest.raises(InputError, match=r"a\.png"):
        open_picture(tmp_path / "a.png")


def test_sizes_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    Image.fromarray(PIXELS[:20]).save(tmp_path / "small.png")
    with pytest.raises(InputError, match="60 x 20"):
        open_picture(tmp_path / "small.png")
    monkeypatch.setattr(safe_pictures, "MAX_PIXELS", 2000)
    Image.fromarray(PIXELS).save(tmp_path / "large.png")
    with pytest.raises(InputError, match="is too large"):
        open_picture(tmp_path / "large.png")
    Image.fromarray(PIXELS).save(tmp_path / "large.gif")
    with pytest.raises(InputError, match="is too large"):
        read_animation(tmp_path / "large.gif")


def test_a_damaged_tiff_is_refused_without_messages(tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    """libtiff and Pillow write to stderr themselves."""
    stream = io.BytesIO()
    Image.fromarray(PIXELS).save(stream, "TIFF", compression="tiff_adobe_deflate")
    data = bytearray(stream.getvalue())
    data[20:60] = b"\xff" * 40
    samples = data.find(b"\x15\x01\x03\x00")  # samples a pixel
    assert samples > 0
    (tmp_path / "a.tif").write_bytes(data)
    more = bytes(data[: samples + 8]) + b"\x00\x08" + bytes(data[samples + 10 :])
    (tmp_path / "b.tif").write_bytes(more)
    for name in ("a.tif", "b.tif"):
        with pytest.raises(InputError):
            open_picture(tmp_path / name)
    assert capfd.readouterr().err == ""
