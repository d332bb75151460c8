"""Files that a visitor brings: a room as photo, scan or mesh, a recording, a radar, a motion or a result folder."""

import secrets
from pathlib import Path
from typing import Any

from mmweaver.core.board import read_board
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import is_installed
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import parse_json, read_json
from mmweaver.formats.radar_file import load_radar
from mmweaver.generate import Weaver
from mmweaver.generation import Room
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.scene.photo.estimated_depth import AUTO
from mmweaver.scene.photo_files import COLOUR, DEPTH, RoomFiles
from mmweaver.scene.scan_folders import scan_kind
from mmweaver.studio.recorded import SETTINGS, read_recorded
from mmweaver.studio.recovery_options import NoWayError
from mmweaver.studio.rooms import read_room
from mmweaver.studio.sessions import BroughtRoom, Session

MAX_BYTES = 300_000_000  # of one upload
MAX_FILES = 200
MAX_DEPTH = 4  # folders within one another
PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".heic")
DEPTHS = (".npy", ".tif", ".tiff")
MOTIONS = (".npz", ".npy")
MESHES = (".glb", ".ply", ".obj")


def take(session: Session, folder: Path, radar: RadarConfig) -> dict[str, Any]:
    """Reads the files of `folder` as what they are together; says what was found. Raises InputError.

    Names were chosen by the server (`place_of`), so nothing outside the folder is ever opened.
    """
    folder = _without_wrappers(folder)
    files = {file.name.lower(): file for file in sorted(folder.iterdir()) if file.is_file()}
    if scan_kind(folder) is not None:
        return _room(session, Weaver(method="physics").read_capture(folder), capture=folder)
    recorded = read_recorded(folder, radar)
    if recorded is not None:
        has_room = bool(recorded.poses)
        return {"kind": "result", "id": session.add(recorded), "label": recorded.title, "has_room": has_room}
    motion = next((file for name, file in files.items() if name.endswith(".bvh")), None)
    if motion is not None or (len(files) == 1 and next(iter(files)).endswith(MOTIONS)):
        return _motion(session, motion or next(iter(files.values())))
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


def said_names(listed: Any, names: list[str | None]) -> list[str]:
    """The names of files as the page said them: JSON with a path of each within what was dropped, else plain names."""
    paths = parse_json(listed, "the paths") if isinstance(listed, str) else None
    if isinstance(paths, list) and len(paths) == len(names) and all(isinstance(one, str) for one in paths):
        return paths
    return [name or "file" for name in names]


def place_of(folder: Path, said: str) -> Path:
    """Where a file is kept: inside `folder` whatever was said, in folders that are made."""
    parts = [part for part in said.replace("\\", "/").split("/") if part.strip(".")]
    for part in parts[-1 - MAX_DEPTH : -1]:
        folder = folder / safe_name(part, set())
        folder.mkdir(exist_ok=True)
    return folder / safe_name(parts[-1] if parts else "file", {file.name for file in folder.iterdir()})


def safe_name(name: str, taken: set[str]) -> str:
    """A plain file name from what a browser sent: no folders, no leading dots, at most 80 characters, not yet taken."""
    plain = "".join(one if one.isalnum() or one in "._-" else "_" for one in name.replace("\\", "/").rsplit("/", 1)[-1])
    plain = plain.lstrip(".")[-80:] or "file"
    while plain in taken:
        plain = f"{secrets.token_hex(2)}-{plain}"
    return plain


def room_with_estimated_depth(session: Session, name: str) -> dict[str, Any]:
    """The room of a photo that was brought without depth. Raises InputError where no model can be had."""
    if name not in session.photos:
        raise InputError("this photo is no longer kept; open its file again")
    photo = session.photos[name]
    return _room(session, Weaver(method="physics").read_room(photo, depth_model=AUTO), rgb=photo, depth_model=AUTO)


def _without_wrappers(folder: Path) -> Path:
    """The folder that was dropped, where it is all that was."""
    inside = list(folder.iterdir())
    is_wrapper = len(inside) == 1 and inside[0].is_dir() and scan_kind(folder) is None
    return _without_wrappers(inside[0]) if is_wrapper else folder


def _photo(session: Session, files: dict[str, Path], folder: Path) -> dict[str, Any]:
    """Files of a room by their names; a depth map is one that says depth, or is .npy or .tif."""
    if any(name in files for name in COLOUR) and any(name in files for name in DEPTH):
        return _photographed(session, RoomFiles.find(folder))
    depth = [one for name, one in files.items() if "depth" in name or one.suffix.lower() in DEPTHS]
    colour = [one for one in files.values() if one not in depth and one.suffix.lower() in PICTURES]
    if not colour:
        raise InputError("the depth has no picture: bring rgb.png of the same view, too")
    if not depth:
        raise _without_depth(session, colour[0])
    camera = next((one for one in files.values() if one.suffix.lower() == ".json"), None)
    return _photographed(session, RoomFiles(rgb=colour[0], depth=depth[0], camera=camera))


def _without_depth(session: Session, photo: Path) -> NoWayError:
    """Offers to estimate the depth where the package for it is installed, else says what to install."""
    name = secrets.token_urlsafe(6)
    session.photos[name] = photo
    said = "a photo alone is not enough: bring its depth too (depth.png in millimetres, or .npy in metres)"
    if not is_installed("transformers"):
        return NoWayError(f"{said}; or pip install 'mmweaver[pretrained]', and a model will estimate it", [])
    return NoWayError(said, [{"label": "estimate the depth (model downloaded once)", "change": {"estimate": name}}])


def _photographed(session: Session, files: RoomFiles) -> dict[str, Any]:
    return _room(session, read_room(files), rgb=files.rgb, depth=files.depth, camera=files.camera)


def _mesh(session: Session, mesh: Path, files: dict[str, Path]) -> dict[str, Any]:
    """A scan or model, with the JSON of its materials where one came along."""
    materials = next((file for name, file in files.items() if name.endswith(".json")), None)
    room = Weaver(method="physics").read_mesh(mesh, materials=materials)
    return _room(session, room, mesh=mesh, mesh_materials=materials)


def _room(session: Session, room: Room, **given: Path | str | None) -> dict[str, Any]:
    """Keeps a room; `given` are the options of `mmweaver generate` that read it, with names for files."""
    words = {name: Path(value).name for name, value in given.items() if value is not None}
    options = [word for name, value in words.items() for word in (f"--{name.replace('_', '-')}", value)]
    first, *more = words.items()
    read = {"mesh": "read_mesh", "capture": "read_capture"}.get(first[0], "read_room")
    arguments = [repr(first[1]), *(f"{name.removeprefix('mesh_')}={value!r}" for name, value in more)]
    name = secrets.token_urlsafe(6)
    label = f"your room {len(session.rooms) + 1}"
    call = f"{read}({', '.join(arguments)})"
    session.rooms[name] = BroughtRoom(label=label, room=room, options=tuple(options), call=call)
    return {"kind": "room", "id": name, "label": label}


def _radar_or_board(session: Session, file: Path) -> dict[str, Any]:
    name = secrets.token_urlsafe(6)
    if file.suffix.lower() == ".json" and "board_version" in _keys(file):
        session.boards[name] = (file.name, read_board(file))
        return {"kind": "board", "id": name, "label": file.name}
    config = load_radar(str(file))
    session.radars[name] = (file.name, config)
    return {"kind": "radar", "id": name, "label": file.name}


def _keys(file: Path) -> set[str]:
    content = read_json(file)
    return set(content) if isinstance(content, dict) else set()


def _motion(session: Session, file: Path) -> dict[str, Any]:
    clip, name = read_motion(file), secrets.token_urlsafe(6)
    session.motions[name] = (file.name, clip)
    return {"kind": "motion", "id": name, "label": file.name}
