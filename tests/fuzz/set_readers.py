"""Readers of Zarr sets: rooms with signals, rooms with geometry, labelled sets; without SHA256SUMS, so that damage
reaches the decoder, and SHA256SUMS itself."""

import io
import json
import random
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import google_crc32c
import numpy as np
import zarr
from numcodecs import zstd
from zarr.storage import MemoryStore

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.datasets import activity_store, geometry_store
from mmweaver.datasets.checked_folder import CheckedFolder
from mmweaver.datasets.dataset_store import read_radar, read_rooms
from mmweaver.datasets.geometry_store import GEOMETRY, StoredGeometry
from mmweaver.datasets.room_generation import RoomGeometry
from mmweaver.datasets.verification import verify
from mmweaver.datasets.zarr_arrays import put_array
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.paths import FrameClock
from mmweaver.propagation.static_paths import FIRST_ORDER
from mmweaver.propagation.static_paths_store import room_of
from tests.fuzz import mutators as m
from tests.fuzz.harness import Reader

SUMS = "SHA256SUMS"
GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "0.2.0.zip"
LENGTHS = [0, 1, 2, 7, 10**4, 10**6, 10**9, 2**40, 2**62, 2**63, -1, 1.0, None]
TYPES = ["float64", "float32", "float16", "int8", "uint64", "complex128", "bool", "string", "r8", "datetime64", "x", 1]
CODECS: list[Any] = [
    {"name": "bytes", "configuration": {"endian": "big"}}, {"name": "zstd", "configuration": {"level": 0}},
    {"name": "gzip", "configuration": {"level": 1}}, {"name": "blosc", "configuration": {}}, {"name": "crc32c"},
    {"name": "transpose", "configuration": {"order": [0]}}, {"name": "vlen-utf8"}, {"name": "numcodecs.pickle"}, {},
]  # fmt: skip
BOMB = zstd.compress(bytes(50_000_000), 1)


def set_readers(folder: Path) -> list[Reader]:
    """All of them, with sound sets made in `folder`."""
    with zipfile.ZipFile(GOLDEN) as archive:
        archive.extractall(folder / "golden")
    rooms, geometry, labelled = folder / "golden" / "dataset", folder / "geometry", folder / "labelled"
    shutil.copytree(folder / "golden" / "results", folder / "summed")
    _without_sums(rooms)
    config = read_radar(rooms)
    _write_geometry(geometry, config)
    _write_labelled(labelled, config)

    def labelled_set(_: Path) -> Any:
        found = activity_store.read_activity_set(labelled)
        return [found.cube(0).values, found.cloud(0).x_m, found.joints_m]

    def stored_geometry(_: Path) -> Any:
        found = StoredGeometry(files=CheckedFolder.of(geometry, "mmweaver dataset"), config=config)
        person = found.motion(0, person=0, height_m=1.7, seed=0)
        return [found.node_joints_m, found.room.paths.length_m.numpy(), person.visibility.skin]

    return [
        members_reader("zarr set", rooms, _whole, _wrong),
        members_reader("zarr geometry", geometry, stored_geometry, _wrong),
        members_reader("zarr labelled set", labelled, labelled_set, _wrong),
        members_reader(SUMS, folder / "summed", _verified, lambda _: None),
    ]


def _verified(folder: Path) -> None:
    found = verify(folder)
    if not found.is_sound:
        raise InputError(f"{found.damaged[0]}; make it anew with: {found.commands[0]}")


def _whole(data: Path) -> list[np.ndarray]:
    found: list[np.ndarray] = []
    for room in read_rooms(data):
        found += [room.joints_m, room.joint_velocity_mps, room.static, room.photo.rgb, room.cube(0).values, room.seed]
    return found


def _wrong(arrays: list[np.ndarray]) -> str | None:
    return None if all(np.isfinite(one).all() for one in arrays) else "numbers that are not finite"


# sound sets ---------------------------------------------------------------------------------------------------------
def _without_sums(data: Path) -> None:
    """As sets of old versions: without checksums, so that damage of files is not noticed by them."""
    for sums in data.rglob(SUMS):
        sums.unlink()
    for file in (data / "zarr.json", *data.glob("*/zarr.json")):
        metadata = json.loads(file.read_text())
        metadata["attributes"].pop("checksums", None)
        file.write_text(json.dumps(metadata))


def _write_geometry(folder: Path, config: RadarConfig) -> None:
    rng = np.random.default_rng(4)
    arrays = {
        "count": np.array([5, 2, 1]), "place_m": rng.uniform(1, 3, (8, 3)).astype("f4"),
        "amplitude": rng.normal(0, 1e-6, (8, 2)).astype("f4"),
        "mirrored_last_m": rng.uniform(1, 3, (2, 3)).astype("f4"),
        "mirrored_way_m": rng.uniform(2, 6, (2, config.num_tx, config.num_rx)),
        "face": np.broadcast_to(np.eye(4, 3), (2, 4, 3)).copy(),
        "face_half_m": np.ones((2, 2)),
    }  # fmt: skip
    room = room_of(arrays, [["wall", "plaster"], ["floor", "wood"]], config, FIRST_ORDER)
    nodes = len(FrameClock(config).node_s)
    seen = Visibility(
        skin=rng.random((2, geometry_store.DEFAULT_NUM_POINTS)) < 0.5,
        over_faces=rng.random((2, 2, geometry_store.GHOST_POINTS)) < 0.5,
        occluded=rng.random((2, 8)) < 0.5,
    )
    trace = rng.normal(size=(2, nodes, 22, 3)).astype("f4"), seen
    geometry = RoomGeometry(room=room, photographed=room)
    geometry_store.write_geometry(zarr.open_group(folder, mode="w"), geometry, [trace])
    assert (folder / GEOMETRY).is_dir()


def _write_labelled(folder: Path, config: RadarConfig) -> None:
    rng = np.random.default_rng(5)
    columns: dict[str, Any] = {name: ["a", "b", "c"] for name in activity_store.STRINGS}
    columns |= {name: [0, 1, 0] for name in activity_store.NUMBERS}
    arrays = {
        "joints_m": rng.normal(size=(3, 2, 22, 3)).astype("f4"), "points": rng.normal(size=(4, 5)).astype("f4"),
        "point_sequence": np.array([0, 0, 1, 2], "i4"), "point_frame": np.array([0, 1, 0, 0], "i4"),
        "iq_scale": np.ones(3, "f4"),
    }  # fmt: skip
    signals = rng.normal(size=(3, *CubeGrid.of(config, 2).shape, 2)).astype("f2")
    activity_store.write_set(folder, config, ("waving", "walking"), columns, arrays, signals, "float16")
    (folder / activity_store.SET_FILE).write_text(json.dumps({"command": "mmweaver dataset set"}))
    (folder / SUMS).write_text("# mmweaver; check with: mmweaver verify DIR, or sha256sum -c SHA256SUMS\n")


# damage -------------------------------------------------------------------------------------------------------------
def members_reader(name: str, data: Path, read: Callable[[Path], Any], wrong: Callable[[Any], str | None]) -> Reader:
    """A reader of a folder; a case is an archive of the files that differ, empty ones are deleted."""
    sound = {file.relative_to(data).as_posix(): file.read_bytes() for file in sorted(data.rglob("*")) if file.is_file()}

    def read_damaged(path: Path) -> Any:
        with zipfile.ZipFile(path) as archive:
            changed = {entry: archive.read(entry) for entry in archive.namelist()}
        try:
            for entry, content in changed.items():
                (data / entry).parent.mkdir(parents=True, exist_ok=True)
                (data / entry).write_bytes(content)
                if not content:
                    (data / entry).unlink()
            return read(data)
        finally:
            for entry in changed:
                if entry in sound:
                    (data / entry).write_bytes(sound[entry])
                else:
                    (data / entry).unlink(missing_ok=True)

    def damaged(rng: random.Random) -> bytes:
        if isinstance(rng, m.Undamaged):
            return archive_of({})
        return archive_of(_damaged_array(sound, rng) if "zarr" in name else _damaged_member(sound, rng))

    return Reader(name, ".members.zip", damaged, read_damaged, wrong)


def archive_of(members: dict[str, bytes]) -> bytes:
    """The bytes of a case: the files that differ from the sound folder."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def _damaged_member(sound: dict[str, bytes], rng: random.Random) -> dict[str, bytes]:
    """One file damaged, most often a text."""
    texts = [name for name, data in sound.items() if data.isascii()]
    name = rng.choice(texts if texts and rng.random() < 0.8 else sorted(sound))
    if name.endswith(".json") and rng.random() < 0.7:
        return {name: m.json_bytes(m.mutated_json(json.loads(sound[name]), rng), rng)}
    if name in texts and rng.random() < 0.7:
        return {name: m.mutated_text(sound[name].decode(), rng).encode("utf-8", "surrogatepass")}
    return {name: m.mutated_bytes(sound[name], rng)}


def _damaged_array(sound: dict[str, bytes], rng: random.Random) -> dict[str, bytes]:
    """Metadata, chunks or values of one array damaged, with the checksum of the chunk made right again."""
    metadata = [name for name in sound if name.endswith("zarr.json")]
    kind = rng.randrange(6)
    if kind == 0:
        return _damaged_member(sound, rng)
    name = rng.choice(metadata)
    content = json.loads(sound[name])
    chunks = [other for other in sound if other.startswith(name.removesuffix("zarr.json") + "c/")]
    if kind == 1 or content["node_type"] == "group" or not chunks:
        return {name: m.json_bytes(m.mutated_json(content, rng), rng)}
    if kind == 2:
        return {name: json.dumps(_another_layout(content, rng)).encode()}
    chunk = rng.choice(chunks)
    if kind == 3:
        return {chunk: rng.choice((b"", _resummed(m.mutated_bytes(sound[chunk], rng)), summed(BOMB), summed(b"")))}
    if kind == 4:
        return {chunk: _resummed(m.mutated_bytes(sound[chunk], rng))}
    return _other_values(name, content, sound, rng)


def _another_layout(content: dict[str, Any], rng: random.Random) -> dict[str, Any]:
    """Metadata that a reader might believe: shapes, chunks, types, codecs and fill values that do not fit the files."""
    grid = content["chunk_grid"]["configuration"]
    for _ in range(rng.choice((1, 1, 2))):
        axis, length = rng.randrange(len(content["shape"]) or 1), rng.choice(LENGTHS)
        kind = rng.randrange(6)
        if kind <= 1 and content["shape"]:
            content["shape"][axis] = length
        if kind in (1, 2) and grid["chunk_shape"]:
            grid["chunk_shape"][axis] = length
        elif kind == 3:
            content["data_type"] = rng.choice(TYPES)
        elif kind == 4:
            content["fill_value"] = rng.choice(("NaN", "Infinity", 1e300, -1, "0x7f", None, True, [1, 2]))
        elif kind == 5:
            codecs = content["codecs"]
            codecs.insert(rng.randrange(len(codecs) + 1), rng.choice(CODECS))
            if rng.random() < 0.5:
                del codecs[rng.randrange(len(codecs))]
    return content


def _resummed(data: bytes) -> bytes:
    return summed(data[:-4])


def summed(data: bytes) -> bytes:
    """A chunk with its CRC-32C."""
    return data + google_crc32c.value(data).to_bytes(4, "little")


def _other_values(name: str, content: dict[str, Any], sound: dict[str, bytes], rng: random.Random) -> dict[str, bytes]:
    """An array written anew with other values, another type or another shape."""
    place = name.removesuffix("zarr.json")
    store = {other.removeprefix(place): data for other, data in sound.items() if other.startswith(place)}
    values = np.asarray(zarr.open_array(MemoryStore(_buffers(store)), mode="r")[...])
    if values.dtype.kind not in "biufc":
        return {name: m.json_bytes(m.mutated_json(content, rng), rng)}
    changed = m.mutated_array(values, rng)
    if changed.dtype.kind not in "biufc" or changed.ndim != values.ndim:  # a file cannot become a folder
        return {name: m.json_bytes(m.mutated_json(content, rng), rng)}
    target = MemoryStore()
    put_array(zarr.open_group(target, mode="w"), "a", changed, tuple(f"axis_{k}" for k in range(changed.ndim)))
    written = {key.removeprefix("a/"): value.to_bytes() for key, value in target._store_dict.items() if key[:2] == "a/"}
    absent = {place + other: b"" for other in store if other not in written}
    return absent | {place + other: data for other, data in written.items()}


def _buffers(store: dict[str, bytes]) -> dict[str, Any]:
    from zarr.core.buffer import default_buffer_prototype

    return {name: default_buffer_prototype().buffer.from_bytes(data) for name, data in store.items()}
