"""Sources of a room: a photo, several photos, a scan, a mesh, or the bundled sample; each becomes a `Room`."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.stages import Stages
from mmweaver.io.result_folder import file_digest
from mmweaver.scene.multiview.view_file import read_views
from mmweaver.scene.photo.capture_photo import DEPTH, PosedPhoto, read_capture_photo
from mmweaver.scene.photo.estimated_depth import scale_note
from mmweaver.scene.photo_files import RoomFiles, sample_photo
from mmweaver.scene.read_photo import classes_of, read_photo
from mmweaver.scene.realsense_bag import is_bag, read_bag_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.scan_folders import read_scan_photo, refuse_unread, scan_kind
from mmweaver.scene.scanned_mesh.read_mesh import SUFFIXES as MESH_SUFFIXES
from mmweaver.weaver.generation import Room

VIEWS_FILE = "views.json"


class RoomReader:
    """Reads rooms and reconstructs them."""

    def __init__(self, listener: Callable[[str], object] | None = None):
        """Creates a reader.

        Args:
            listener: Called with the name of each stage as it begins.
        """
        self._listener = listener

    def read_room(
        self, rgb: str | Path, depth: str | Path | None = None, camera: str | Path | None = None, **seen: Any
    ) -> Room:
        """Reads a photo with depth and reconstructs the room.

        Args:
            rgb: Colour picture.
            depth: 16-bit PNG, or .npy in metres; None to estimate it.
            camera: JSON of the camera's intrinsics.
            **seen: `depth_model` estimates a missing depth; `depth_unit` and `depth_kind` say what a depth picture
                holds; `classes` (a picture of class numbers) or the models
                `segmenter` and `sam` give the class of each pixel, which determines materials. See
                `scene.read_photo.read_photo`.

        Raises:
            InputError: If a file cannot be read or used.
        """
        stages = Stages(self._listener)
        with stages("read the photo"):
            photo, assumptions = read_photo(rgb, depth, camera, **seen)
            files = {"rgb": rgb, "depth": depth, "camera": camera, "classes": seen.get("classes")}
            inputs: dict[str, Any] = {name: file_digest(path) for name, path in files.items() if path is not None}
            models = ("depth_model", "segmenter", "sam")
            inputs |= {name: str(seen[name]) for name in models if seen.get(name) is not None}
        room = self._reconstruct(photo, assumptions, inputs, stages)
        note = scale_note(-room.scene.floor_z_m) if depth is None else None
        if note is None:
            return room
        return replace(room, scene=replace(room.scene, assumptions=(*room.scene.assumptions, note)))

    def read_views(self, views: str | Path, *, segmenter: str | None = None) -> Room:
        """Reads several photos with depth and reconstructs the room. The radar is at the first one.

        Args:
            views: A views.json with the photos and their poses, see `scene.multiview.view_file`.
            segmenter: Model that gives the class of each pixel.

        Raises:
            InputError: If a file cannot be read or used.
        """
        stages = Stages(self._listener)
        with stages("read the photos"):
            found = read_views(Path(views), segmenter=segmenter)
            inputs: dict[str, Any] = {name: file_digest(path) for name, path in found.files.items()}
            inputs |= {} if segmenter is None else {"segmenter": segmenter}
        return self._reconstruct(found.photo, found.assumptions, inputs, stages, found.others)

    def read_capture(
        self,
        capture: str | Path,
        *,
        photo: int = 0,
        rgb: str | Path | None = None,
        extra_views: Sequence[int] | str = (),
        **seen: Any,
    ) -> Room:
        """Reads a photo of a capture folder or of a scan, and reconstructs the room.

        Capture folders are of mmwave-capture-std (color.avi and depth.zst of a RealSense); scans are of Stray Scanner,
        Record3D, Polycam (raw data), ScanNet or TUM RGB-D, or a ROS bag.

        Args:
            capture: The folder or file.
            photo: Number of the photo.
            rgb: Picture used instead of the frame of color.avi, where that cannot be decoded.
            extra_views: Numbers of further photos of a scan that show more of the room, or "auto".
            **seen: `classes`, `segmenter` and `sam` as in `read_room`.

        Raises:
            InputError: If a file cannot be read or used, or `extra_views` are requested of a source without poses.
        """
        if extra_views and (scan_kind(Path(capture)) is None or rgb is not None):
            raise InputError(
                "only scans with poses are joined of several photos: Stray Scanner, Record3D, Polycam, "
                "ScanNet, TUM RGB-D"
            )
        stages = Stages(self._listener)
        with stages("read the photo"):
            if not is_bag(Path(capture)):
                refuse_unread(Path(capture))
            if is_bag(Path(capture)) and rgb is None:
                found = read_bag_photo(Path(capture), photo)
            elif scan_kind(Path(capture)) is not None and rgb is None:
                found = read_scan_photo(Path(capture), photo, extra_views)
            else:
                found = read_capture_photo(capture, photo, None if rgb is None else Path(rgb))
            inputs = {"photo": photo, **{name: file_digest(path) for name, path in found.files.items()}}
            inputs |= {name: str(source) for name, source in seen.items() if source is not None}
            whole = replace(found.photo, classes=classes_of(found.photo, **seen))
            models = {name: seen.get(name) for name in ("segmenter", "sam")}
            others = [
                replace(one, photo=replace(one.photo, classes=classes_of(one.photo, **models))) for one in found.others
            ]
        return self._reconstruct(whole, found.assumptions, inputs, stages, others)

    def read_mesh(self, mesh: str | Path, **how: Any) -> Room:
        """Reads a mesh with triangles (GLB, PLY or OBJ) as a room. Needs the extra 'mesh'.

        Args:
            mesh: The file.
            **how: `eye` and `look_deg`, place and direction of the radar in the mesh, by default chosen; `unit` and
                `up`, where the file does not state them; `materials`, a JSON of names and classes. See
                `scene.scanned_mesh.mesh_photo.read_mesh_photo`.

        Raises:
            InputError: If the file cannot be read or used.
        """
        from mmweaver.scene.scanned_mesh.mesh_photo import read_mesh_photo

        stages = Stages(self._listener)
        with stages("read the mesh"):
            found = read_mesh_photo(Path(mesh), **how)
            files = {"mesh": mesh, "materials": how.get("materials")}
            inputs: dict[str, Any] = {name: file_digest(path) for name, path in files.items() if path is not None}
            settings = ("eye", "look_deg", "unit", "up")
            inputs |= {name: how[name] for name in settings if how.get(name) is not None}
        return self._reconstruct(found.photo, found.assumptions, inputs, stages, found.others)

    def open_room(self, path: str | Path, **how: Any) -> Room:
        """Reads the room at a path, whatever its kind.

        Args:
            path: Folder with rgb.png and depth.png (and camera.json), views.json or a folder with it, a scan or
                capture folder, a ROS bag (RealSense), or a mesh.
            **how: Arguments of `read_mesh`, `read_views`, `read_capture` or `read_room` other than the files of the
                folder.

        Raises:
            InputError: For anything else, and for a keyword that does not apply to this kind of room.
        """
        place = Path(path)
        views = next((one for one in (place, place / VIEWS_FILE) if one.name == VIEWS_FILE and one.is_file()), None)
        is_capture = any(place.glob(f"*/{DEPTH}")) or (place / DEPTH).is_file()
        if place.suffix.lower() in MESH_SUFFIXES:
            return self.read_mesh(place, **_known(how, "a mesh", "eye", "look_deg", "unit", "up", "materials"))
        if views is not None:
            return self.read_views(views, **_known(how, "views.json", "segmenter"))
        if is_bag(place) or is_capture or scan_kind(place) is not None:
            known = _known(how, "a scan", "photo", "rgb", "extra_views", "classes", "segmenter", "sam")
            return self.read_capture(place, **known)
        refuse_unread(place)
        files = RoomFiles.find(place)
        known = _known(how, "a photo", "classes", "segmenter", "sam", "depth_unit", "depth_kind")
        return self.read_room(files.rgb, files.depth, files.camera, **known)

    def sample_room(self) -> Room:
        """The bundled sample room."""
        stages = Stages(self._listener)
        with stages("read the photo"):
            photo, assumptions = sample_photo()
        return self._reconstruct(photo, assumptions, {"sample": "the bundled room"}, stages)

    @staticmethod
    def _reconstruct(
        photo: RgbdPhoto,
        assumptions: tuple[str, ...],
        inputs: dict[str, Any],
        stages: Stages,
        others: Sequence[PosedPhoto] = (),
    ) -> Room:
        with stages("reconstruct the room"):
            scene = reconstruct(photo, others, assumptions=assumptions)
        return Room(scene=scene, inputs=inputs, seconds=stages.seconds, views=tuple(others))


def _known(how: dict[str, Any], what: str, *names: str) -> dict[str, Any]:
    """The options; InputError for one that does not apply to this kind of room."""
    if unknown := [name for name in how if name not in names]:
        raise InputError(f"{unknown[0].removesuffix('_deg')} says nothing of a room from {what}; leave it out")
    return how
