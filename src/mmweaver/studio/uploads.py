"""Uploads of a visitor: a room as photo, scan or mesh, a recording, a radar, a motion or a result folder."""

import secrets
from pathlib import Path
from typing import Any

from mmweaver.core.board import read_board
from mmweaver.core.errors import InputError, error_code
from mmweaver.core.optional_packages import is_installed
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import parse_json, read_json
from mmweaver.io.radar_file import load_radar
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.scene.photo.estimated_depth import AUTO
from mmweaver.scene.photo_files import COLOUR, DEPTH, RoomFiles
from mmweaver.scene.scan_folders import scan_kind
from mmweaver.studio.recordings import SETTINGS, read_recorded
from mmweaver.studio.service import RecoverableError
from mmweaver.studio.sessions import BroughtRoom, Session
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room

MAX_BYTES = 300_000_000  # of one upload
MAX_FILES = 200
NO_DEPTH = "photo_without_depth"  # code of the error
MAX_DEPTH = 4  # folders within one another
MAX_NAME_CHARACTERS, MAX_NAME_BYTES = 80, 200
PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".heic")
DEPTHS = (".npy", ".tif", ".tiff")
MOTIONS = (".npz", ".npy")
MESHES = (".glb", ".ply", ".obj")


@error_code("upload")
def take(session: Session, folder: Path, radar: RadarConfig) -> dict[str, Any]:
    """Interprets the files of a folder, and adds the result to a session.

    File names were chosen by the server (`place_of`), so nothing outside the folder is ever opened.

    Args:
        session: The session.
        folder: Folder of the uploaded files.
        radar: Radar of raw samples that have no .cfg.

    Returns:
        What was found, for the page.

    Raises:
        InputError: If the files cannot be used.
    """
    folder = _unwrapped(folder)
    files = {file.name.lower(): file for file in sorted(folder.iterdir()) if file.is_file()}
    if scan_kind(folder) is not None:
        return _room(session, _weaver().open_room(folder), room=folder)
    recorded = read_recorded(folder, radar)
    if recorded is not None:
        has_room = bool(recorded.poses)
        return {"kind": "result", "id": session.add(recorded), "label": recorded.title, "has_room": has_room}
    motion = next((file for name, file in files.items() if name.endswith(".bvh")), None)
    if motion is not None or (len(files) == 1 and next(iter(files)).endswith(MOTIONS)):
        file = motion or next(iter(files.values()))
        return _named(session, session.motions, "motion", file, read_motion(file))
    mesh = next((file for name, file in files.items() if name.endswith(MESHES)), None)
    if mesh is not None:
        return _mesh(session, mesh, files)
    if any(name.endswith((*PICTURES, *DEPTHS)) for name in files):
        return _photo(session, files, folder)
    settings = next((file for name, file in files.items() if name.endswith(SETTINGS)), None)
    if settings is not None:
        return _radar_or_board(session, settings)
    raise InputError(
        f"nothing here is known: {', '.join(sorted(files)[:5])}; bring rgb.png with depth.png (and camera.json), a scan"
        " or a mesh (.glb, .ply, .obj), a .bin with its .cfg, a .dat, a .cfg, radar.json or board.json, a motion (.bvh,"
        " .npz, .npy), or a result folder"
    )


def file_names(listed: Any, names: list[str | None]) -> list[str]:
    """File names sent by the page: paths within what was dropped, as JSON, or otherwise plain names."""
    paths = parse_json(listed, "the paths") if isinstance(listed, str) else None
    if isinstance(paths, list) and len(paths) == len(names) and all(isinstance(one, str) for one in paths):
        return paths
    return [name or "file" for name in names]


def place_of(folder: Path, said: str) -> Path:
    """Path for an uploaded file, always inside `folder`; subfolders are created.

    Args:
        folder: Folder of the upload.
        said: Path sent by the browser.
    """
    parts = [part for part in said.replace("\\", "/").split("/") if part.strip(".")]
    for part in parts[-1 - MAX_DEPTH : -1]:
        folder = folder / safe_name(part, {file.name for file in folder.iterdir() if not file.is_dir()})
        folder.mkdir(exist_ok=True)
    return folder / safe_name(parts[-1] if parts else "file", {file.name for file in folder.iterdir()})


def safe_name(name: str, taken: set[str]) -> str:
    """A plain file name from what a browser sent: no folders, no leading dots, neither too long nor taken."""
    plain = "".join(one if one.isalnum() or one in "._-" else "_" for one in name.replace("\\", "/").rsplit("/", 1)[-1])
    plain = (
        plain.lstrip(".")[-MAX_NAME_CHARACTERS:].encode("utf-8", "ignore")[-MAX_NAME_BYTES:].decode("utf-8", "ignore")
    )
    plain = plain or "file"
    while plain in taken:
        plain = f"{secrets.token_hex(2)}-{plain}"
    return plain


def room_with_estimated_depth(session: Session, name: str) -> dict[str, Any]:
    """The room of a photo that was uploaded without depth; InputError if no depth model is available."""
    if name not in session.photos:
        raise InputError("this photo is no longer kept; open its file again")
    photo = session.photos[name]
    return _room(session, _weaver().read_room(photo, depth_model=AUTO), rgb=photo, depth=AUTO)


def _weaver() -> Weaver:
    return Weaver(method="physics")


def _unwrapped(folder: Path) -> Path:
    """The single folder within an upload, if it contains nothing else."""
    inside = list(folder.iterdir())
    is_wrapper = len(inside) == 1 and inside[0].is_dir() and scan_kind(folder) is None
    return _unwrapped(inside[0]) if is_wrapper else folder


def _photo(session: Session, files: dict[str, Path], folder: Path) -> dict[str, Any]:
    """Files of a room by their names; a depth map has "depth" in its name, or is .npy or .tif."""
    if any(name in files for name in COLOUR) and any(name in files for name in DEPTH):
        return _photographed(session, RoomFiles.find(folder))
    depth = [one for name, one in files.items() if "depth" in name or one.suffix.lower() in DEPTHS]
    colour = [one for one in files.values() if one not in depth and one.suffix.lower() in PICTURES]
    if not colour:
        raise InputError("the depth has no picture: bring rgb.png of the same view, too")
    if not depth:
        raise _drop_depth(session, colour[0])
    camera = next((one for one in files.values() if one.suffix.lower() == ".json"), None)
    return _photographed(session, RoomFiles(rgb=colour[0], depth=depth[0], camera=camera))


def _drop_depth(session: Session, photo: Path) -> RecoverableError:
    """Offers to estimate the depth if the package is installed, otherwise names what to install."""
    name = secrets.token_urlsafe(6)
    session.bring(session.photos, name, photo)
    said = "a photo alone is not enough: bring its depth too (depth.png in millimetres, or .npy in metres)"
    if not is_installed("transformers"):
        return RecoverableError(
            f"{said}; or pip install 'mmweaver[pretrained]', and a model will estimate it", [], NO_DEPTH
        )
    button = {"label": "estimate the depth (model downloaded once)", "change": {"estimate": name}}
    return RecoverableError(said, [button], NO_DEPTH)


def _photographed(session: Session, files: RoomFiles) -> dict[str, Any]:
    room = _weaver().read_room(files.rgb, files.depth, files.camera)
    return _room(session, room, rgb=files.rgb, depth=files.depth, camera=files.camera)


def _mesh(session: Session, mesh: Path, files: dict[str, Path]) -> dict[str, Any]:
    """A scan or model, with the JSON of its materials if there is one."""
    materials = next((file for name, file in files.items() if name.endswith(".json")), None)
    return _room(session, _weaver().read_mesh(mesh, materials=materials), room=mesh, materials=materials)


def _room(session: Session, found: Room, /, **given: Path | str | None) -> dict[str, Any]:
    """Keeps a room; `given` are the options of `mmweaver generate` that read it, by name of the file."""
    words = {name: Path(value).name for name, value in given.items() if value is not None}
    pairs = [
        ("mesh-set", f"materials={value}") if name == "materials" else (name, value) for name, value in words.items()
    ]
    options = tuple(word for name, value in pairs for word in (f"--{name}", value))
    is_model = words.get("depth") == AUTO
    words = {"depth_model" if is_model and name == "depth" else name: value for name, value in words.items()}
    first, *more = words.items()
    arguments = [repr(first[1]), *(f"{name}={value!r}" for name, value in more)]
    call = f"{'open_room' if first[0] == 'room' else 'read_room'}({', '.join(arguments)})"
    name, label = secrets.token_urlsafe(6), f"your room {len(session.rooms) + 1}"
    session.bring(session.rooms, name, BroughtRoom(label=label, options=options, call=call, read=lambda: found))
    return {"kind": "room", "id": name, "label": label}


def _radar_or_board(session: Session, file: Path) -> dict[str, Any]:
    is_json = file.suffix.lower() == ".json"
    content = read_json(file) if is_json else None
    if isinstance(content, dict) and "board_version" in content:
        return _named(session, session.boards, "board", file, read_board(file))
    return _named(session, session.radars, "radar", file, load_radar(str(file)))


def _named(session: Session, kept: dict[str, Any], kind: str, file: Path, value: Any) -> dict[str, Any]:
    """Keeps the contents of a file under a new id, with the file's name."""
    name = secrets.token_urlsafe(6)
    session.bring(kept, name, (file.name, value))
    return {"kind": kind, "id": name, "label": file.name}
