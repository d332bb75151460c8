"""The files of a room in a folder by their names: photo, depth and camera.

The bundled sample room, rendered by tools/make_sample_room.py.
"""

from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.scene.read_photo import read_photo

SAMPLE_FOLDER = Path(__file__).resolve().parents[1] / "sample"


def sample_photo() -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Reads the photo of the bundled sample room, with the assumptions of `read_photo`."""
    return read_photo(SAMPLE_FOLDER / "rgb.webp", SAMPLE_FOLDER / "depth.png", SAMPLE_FOLDER / "camera.json")


COLOUR, DEPTH, CAMERA = (
    ("rgb.png", "rgb.jpg", "rgb.jpeg", "rgb.webp"),
    ("depth.png", "depth.npy", "depth.tif", "depth.tiff"),
    "camera.json",
)


@dataclass(frozen=True, kw_only=True)
class RoomFiles:
    """Paths of a photo, its depth and, if present, its camera file."""

    rgb: Path
    depth: Path
    camera: Path | None

    @classmethod
    def find(cls, folder: Path) -> "RoomFiles":
        """Finds the files of a room by name.

        Args:
            folder: Folder with rgb.png (or .jpg, .jpeg, .webp), depth.png (or .npy, .tif, .tiff), and camera.json if
                known.

        Raises:
            InputError: If the photo or the depth is missing.
        """
        check_exists(folder, f"a folder with {COLOUR[0]} and {DEPTH[0]}")
        rgb = next((folder / name for name in COLOUR if (folder / name).is_file()), None)
        depth = next((folder / name for name in DEPTH if (folder / name).is_file()), None)
        if rgb is None or depth is None:
            missing, names = ("colour picture", COLOUR) if rgb is None else ("depth", DEPTH)
            raise InputError(
                f"{folder.name}: the {missing} is missing; a room needs {names[0]} (or {', '.join(names[1:])})"
            )
        camera = folder / CAMERA
        return cls(rgb=rgb, depth=depth, camera=camera if camera.is_file() else None)

    @property
    def options(self) -> list[str]:
        """The files as command-line options."""
        camera = [] if self.camera is None else ["--camera", str(self.camera)]
        return ["--rgb", str(self.rgb), "--depth", str(self.depth), *camera]

    @property
    def call(self) -> str:
        """The files as a Python call of `read_room`."""
        camera = "" if self.camera is None else f", {str(self.camera)!r}"
        return f"read_room({str(self.rgb)!r}, {str(self.depth)!r}{camera})"
