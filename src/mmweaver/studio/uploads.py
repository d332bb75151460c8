"""Files that a visitor brings: a photo with depth, a recording, a radar, a motion or a result folder."""

import secrets
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.formats.radar_file import load_radar
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.recordings.processing import process_recording
from mmweaver.scene.photo_files import COLOUR, DEPTH, RoomFiles
from mmweaver.stored_result import read_result
from mmweaver.studio.rooms import read_room
from mmweaver.studio.sessions import Result, Session

MAX_BYTES = 300_000_000  # of one upload
MAX_FILES = 40
PICTURES = (".png", ".jpg", ".jpeg", ".webp")


def take(session: Session, folder: Path, radar: RadarConfig) -> dict[str, Any]:
    """Reads the files of `folder` as what they are together; says what was found. Raises InputError.

    Names were chosen by the server (`safe_name`), so nothing outside the folder is ever opened.
    """
    files = {file.name.lower(): file for file in sorted(folder.iterdir())}
    if "radar.npz" in files and "radar.json" in files:
        return _result(session, folder)
    recording = next((file for name, file in files.items() if name.endswith(".bin")), None)
    if recording is not None:
        settings = next((file for name, file in files.items() if name.endswith((".cfg", ".json"))), None)
        return _recording(session, recording, radar if settings is None else str(settings))
    motion = next((file for name, file in files.items() if name.endswith(".bvh")), None)
    if motion is not None or (len(files) == 1 and next(iter(files)).endswith((".npz", ".npy"))):
        return _motion(session, motion or next(iter(files.values())))
    if any(name.endswith((*PICTURES, ".npy", ".tif", ".tiff")) for name in files):
        return _room(session, _named_as_room(files, folder))
    settings = next((file for name, file in files.items() if name.endswith((".cfg", ".json"))), None)
    if settings is not None:
        return _radar(session, settings)
    raise InputError(
        f"nothing here is known: {', '.join(sorted(files)[:5])}; bring rgb.png with depth.png (and camera.json), a .bin"
        " with its .cfg, a .cfg or radar.json alone, a motion (.bvh, .npz, .npy), or the files of a result folder"
    )


def safe_name(name: str, taken: set[str]) -> str:
    """A plain file name from what a browser sent: no folders, no leading dots, at most 80 characters, not yet taken."""
    plain = "".join(one if one.isalnum() or one in "._-" else "_" for one in name.replace("\\", "/").rsplit("/", 1)[-1])
    plain = plain.lstrip(".")[-80:] or "file"
    while plain in taken:
        plain = f"{secrets.token_hex(2)}-{plain}"
    return plain


def _named_as_room(files: dict[str, Path], folder: Path) -> RoomFiles:
    """Files of a room by their names; a depth map is one that says depth, or is .npy or .tif."""
    if not any(name in files for name in COLOUR) or not any(name in files for name in DEPTH):
        depth = [
            one for name, one in files.items() if "depth" in name or one.suffix.lower() in (".npy", ".tif", ".tiff")
        ]
        colour = [one for one in files.values() if one not in depth and one.suffix.lower() in PICTURES]
        if not depth:
            raise InputError(
                "a photo alone is not enough: bring its depth too (depth.png in millimetres, or .npy in metres); a"
                " metric depth model can estimate it: mmweaver generate --depth-model"
            )
        if not colour:
            raise InputError("the depth has no picture: bring rgb.png of the same view, too")
        camera = next((one for one in files.values() if one.suffix.lower() == ".json"), None)
        return RoomFiles(rgb=colour[0], depth=depth[0], camera=camera)
    return RoomFiles.in_folder(folder)


def _room(session: Session, files: RoomFiles) -> dict[str, Any]:
    room = read_room(files)
    name = secrets.token_urlsafe(6)
    label = f"your room {len(session.rooms) + 1}"
    session.rooms[name] = (label, room)
    return {"kind": "room", "id": name, "label": label}


def _radar(session: Session, file: Path) -> dict[str, Any]:
    config, name = load_radar(str(file)), secrets.token_urlsafe(6)
    session.radars[name] = (file.name, config)
    return {"kind": "radar", "id": name, "label": file.name}


def _motion(session: Session, file: Path) -> dict[str, Any]:
    clip, name = read_motion(file), secrets.token_urlsafe(6)
    session.motions[name] = (file.name, clip)
    return {"kind": "motion", "id": name, "label": file.name}


def _recording(session: Session, file: Path, radar: RadarConfig | str) -> dict[str, Any]:
    done = process_recording(file, radar)
    result = Result(cube=done.cube, points=done.points, poses=(), meta={**done.meta, "text": file.name})
    return {"kind": "result", "id": session.add(result), "label": file.name, "has_room": False}


def _result(session: Session, folder: Path) -> dict[str, Any]:
    stored = read_result(folder)
    result = Result(cube=stored.cube, points=stored.points, poses=stored.poses, meta=stored.meta)
    return {"kind": "result", "id": session.add(result), "label": stored.title, "has_room": bool(stored.poses)}
