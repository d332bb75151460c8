"""The bundled sample room, rendered by tools/make_sample_room.py."""

from pathlib import Path

from mmweaver.core.records import RgbdPhoto
from mmweaver.scene.read_photo import read_photo

SAMPLE_FOLDER = Path(__file__).resolve().parents[1] / "sample"


def sample_photo() -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Reads the photo of the bundled sample room, with the assumptions of `read_photo`."""
    return read_photo(SAMPLE_FOLDER / "rgb.webp", SAMPLE_FOLDER / "depth.png", SAMPLE_FOLDER / "camera.json")
