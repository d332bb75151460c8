"""Generates the missing rooms of a data set on the cores of this machine or on a Ray cluster.

Writes data sets: the root, and each room under a temporary name that is replaced once it is complete.

A kill at any instant loses only unfinished rooms, and several processes may work on one set. The root follows from
plan.json, which the first process creates; each process completes what is missing. Layout: `dataset_store`.
"""

import hashlib
import itertools
import json
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file, atomic_files, create_once, staged_folder
from mmweaver.core.checksums import SUMS_FILE, damages, read_sums, sums_text, write_sums
from mmweaver.core.errors import InputError
from mmweaver.core.locks import locked
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import cannot_write, is_empty, resolved
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.safe_files.packed_folder import pack_folder
from mmweaver.core.safe_files.regular_files import MEGABYTE, Place, read_bytes
from mmweaver.core.safe_files.safe_text import parse_json, read_json
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.core.staging import is_staged, remove, staging_path, sweep, sync, sync_tree
from mmweaver.datasets.data_card import write_rooms_card
from mmweaver.datasets.dataset_folder import PACKED, PLAN_FILE, finished, room_place
from mmweaver.datasets.dataset_plan import ACTIVITIES, RADAR_FILE, DatasetPlan
from mmweaver.datasets.geometry_store import write_geometry
from mmweaver.datasets.zarr_arrays import (
    IQ_DIMENSIONS,
    SequenceWriter,
    name_parts,
    packed_iq,
    put_array,
    put_photo,
    put_texts,
    zarr_module,
)

if TYPE_CHECKING:
    from mmweaver.core.records import RadarCube
    from mmweaver.datasets.room_generation import GeneratedRoom

AHEAD = 4  # rooms queued per worker: the plan is not held in memory
LARGEST_ROOT_FILE = 64 * MEGABYTE
# dimensions and coordinates share their names, so that rooms inherit those of the root in xarray.open_datatree
COORDINATES = {"frame_time": "frame_time_s", "range": "range_m", "radial_velocity": "radial_velocity_mps"}
AXES = (*COORDINATES, "antenna_position_m")
ROOT_NAMES = (PLAN_FILE, RADAR_FILE, "zarr.json", *AXES, SUMS_FILE)


def open_dataset(folder: Path, plan: DatasetPlan, config: RadarConfig) -> None:
    """Creates the folder of a data set, or completes an existing one with the same plan and radar.

    Args:
        folder: The data set.
        plan: Its plan.
        config: Its radar.

    Raises:
        InputError: If the folder contains something else, or a data set with another plan or radar.
    """
    target = resolved(folder)
    text = plan.to_json()
    if not (target / PLAN_FILE).is_file() and not _can_begin(target):
        raise InputError(f"{folder} is not empty and holds no data set; choose another folder")
    if create_once(target / PLAN_FILE, text) != text:
        raise InputError(f"{folder} holds a data set of another plan; choose another folder or the same settings")
    stage = staging_path(target / "axes")
    try:
        _write_root(stage, plan, config)
        if read_sums(target) is None:
            _move_entries(stage, target)
        elif not (target / RADAR_FILE).is_file():
            raise InputError(f"{target / RADAR_FILE} is missing; make it anew with the same command and --repair")
        elif _read(target / RADAR_FILE) != _read(stage / RADAR_FILE):
            raise InputError(f"{folder} holds a data set of another radar; choose another folder or the same radar")
    except OSError as error:
        raise cannot_write(folder, error) from error
    finally:
        remove(stage)


def _can_begin(target: Path) -> bool:
    """Whether a folder is new or empty, or was left by a kill before its plan was written."""
    if not target.exists() or is_empty(target):
        return True
    others = {entry.name for entry in target.iterdir() if not is_staged(entry.name)}
    return others <= {*ROOT_NAMES, f".{PLAN_FILE}"}


def _write_root(stage: Path, plan: DatasetPlan, config: RadarConfig) -> None:
    root = zarr_module().open_group(stage, mode="w")
    grid = CubeGrid.of(config, plan.num_frames)
    for name, of_grid in COORDINATES.items():
        put_array(root, name, getattr(grid, of_grid), (name,))
    put_array(root, "antenna_position_m", grid.antenna_position_m, ("antenna", "axis"))
    root.attrs.update(
        {
            "made_by": "mmweaver dataset",
            "radar": parse_json(config.to_json(), "the radar"),
            "joints": list(JOINT_NAMES),
            "wavelength_m": config.wavelength_m,
            "checksums": SUMS_FILE,
        }
    )
    (stage / PLAN_FILE).write_text(plan.to_json(), encoding="utf-8")
    (stage / RADAR_FILE).write_text(config.to_json(), encoding="utf-8")
    write_sums(stage)


def _move_entries(stage: Path, target: Path) -> None:
    """Moves entries that are missing or differ, checksums last; other processes may do the same concurrently."""
    sync_tree(stage)
    for name in ROOT_NAMES:
        if _contents(stage / name) == _contents(target / name):
            continue
        if (target / name).is_dir():
            remove(target / name)
        try:
            (stage / name).rename(target / name)
        except OSError:
            if not (target / name).is_dir():  # else another process was quicker
                raise
    remove(target / f".{PLAN_FILE}")
    sync(target)


def _contents(place: Path) -> dict[str, bytes]:
    files = [place] if place.is_file() else sorted(file for file in place.rglob("*") if file.is_file())
    return {file.relative_to(place).as_posix(): _read(file) for file in files}


def _read(file: Path) -> bytes:
    return read_bytes(file, max_bytes=LARGEST_ROOT_FILE)


def remove_damaged(folder: Path, plan: DatasetPlan) -> list[str]:
    """Removes damaged rooms and a damaged root of a data set, so that they are generated again.

    Args:
        folder: The data set.
        plan: Its plan.

    Returns:
        Names of the removed rooms.

    Raises:
        InputError: If the folder contains a data set with another plan.
    """
    if not (folder / PLAN_FILE).is_file() and not (folder / SUMS_FILE).is_file():
        return []
    text = plan.to_json()
    sums = _sums_or_none(folder)
    if sums is None or damages(folder):
        is_ours = (sums or {}).get(PLAN_FILE) == hashlib.sha256(text.encode()).hexdigest()
        if not is_ours and _read(folder / PLAN_FILE) != text.encode():
            raise InputError(f"{folder} holds a data set of another plan; give the settings it was made with")
        remove(folder / SUMS_FILE)
        with atomic_file(folder / PLAN_FILE) as temporary:
            temporary.write_text(text, encoding="utf-8")
    names = [plan.name_of(number) for number in range(plan.num_rooms)]
    damaged = sorted(name for name in finished(folder, names) if _is_damaged(room_place(folder, name)))
    for name in damaged:
        place = folder / room_place(folder, name).name
        away = staging_path(place)
        place.rename(away)
        remove(away)
    return damaged


def _sums_or_none(folder: Place) -> dict[str, str] | None:
    try:
        return read_sums(folder)
    except InputError:
        return None


def _is_damaged(room: Place) -> bool:
    return _sums_or_none(room) is None or bool(damages(room))


@contextmanager
def new_room(folder: Path, name: str, *, packed: bool = False) -> Iterator[Path]:
    """Writes one room atomically; an existing room is kept, since equal plans give identical data.

    Args:
        folder: The data set.
        name: Name of the room.
        packed: Whether the room becomes one zip, which is synced once. Default: a folder, synced file by file.

    Yields:
        A temporary folder for the files of the room.

    Raises:
        InputError: If it cannot be written.
    """
    target = resolved(folder) / name
    if not packed:
        with staged_folder(target, keep_existing=True) as partial:
            yield partial
        return
    stage = staging_path(target)
    try:
        stage.mkdir()
        yield stage
        write_sums(stage)
        with atomic_file(target.with_name(f"{name}{PACKED}")) as file:
            pack_folder(stage, file)
    except OSError as error:
        raise cannot_write(folder, error) from error
    finally:
        remove(stage)


class _CubeWriter:
    """Writes the cubes of a room as they are made, so that memory does not grow with their number."""

    def __init__(self, group: Any, config: RadarConfig, num_sequences: int, num_frames: int):
        shape = (num_sequences, *CubeGrid.of(config, num_frames).shape, 2)
        self.group, self.scales = group, list[float]()
        self.writer = SequenceWriter(group, "iq", "float16", shape, IQ_DIMENSIONS)

    def add(self, cube: "RadarCube") -> None:
        pairs, scale = packed_iq(cube)
        self.writer.add(pairs)
        self.scales.append(scale)

    def close(self) -> None:
        self.writer.close()
        if self.scales:
            name_parts(self.group)
            put_array(self.group, "iq_scale", np.array(self.scales), ("sequence",))


def _put_room(group: Any, generated: "GeneratedRoom") -> None:
    """Writes everything of a room except its signals."""
    _put_sequences(group, generated)
    put_photo(group, generated.photo)
    _put_clutter(group, generated.static)
    group.attrs.update(_attributes(generated))


def _put_sequences(group: Any, generated: "GeneratedRoom") -> None:
    sequences = generated.sequences
    if generated.geometry is not None:
        write_geometry(group, generated.geometry, [s.trace for s in sequences if s.trace is not None])
    if sequences:
        pose = ("sequence", "frame_time", "joint", "axis")
        put_array(group, "joints_m", np.stack([s.joints_m for s in sequences]), pose)
        put_array(group, "joint_velocity_mps", np.stack([s.joint_velocity_mps for s in sequences]), pose)
        put_array(group, "subject", np.array([s.spec.person for s in sequences], np.int32), ("sequence",))
        put_array(group, "seed", np.array([s.spec.seed for s in sequences], np.uint64), ("sequence",))
        labels = np.array([list(ACTIVITIES).index(s.spec.activity) for s in sequences], np.int32)
        put_array(group, "label", labels, ("sequence",))
        put_texts(group, "label_name", [s.spec.activity for s in sequences])
        put_texts(group, "text", [s.spec.text for s in sequences])
        put_texts(group, "split", [s.spec.split for s in sequences])


def _put_clutter(group: Any, static: np.ndarray) -> None:
    put_array(group, "empty_iq", np.stack([np.real(static), np.imag(static)], -1), ("range", "antenna", "part"))


def _attributes(generated: "GeneratedRoom") -> dict[str, Any]:
    spec, sequences = generated.spec, generated.sequences
    return {
        "kind": spec.kind,
        "layout": spec.layout,
        "lighting": spec.lighting,
        "checksums": SUMS_FILE,
        "activity": [s.spec.activity for s in sequences],
        "text": [s.spec.text for s in sequences],
        "split": [s.spec.split for s in sequences],
        "index": [s.spec.index for s in sequences],
        "refused": [list(entry) for entry in generated.refused],
    }


METADATA = "zarr.json"
KEY = "consolidated_metadata"


def consolidate_rooms(folder: Path, rooms: Sequence[str], axes: Sequence[str]) -> None:
    """Completes the consolidated metadata in the root's zarr.json, and its checksum.

    Args:
        folder: The data set.
        rooms: Names of the rooms.
        axes: Names of the arrays in the root.

    Raises:
        InputError: If metadata is damaged.
    """
    root = read_json(folder / METADATA)
    files = [file for name in (*axes, *sorted(rooms)) for file in sorted((folder / name).rglob(METADATA))]
    members: dict[str, Any] = {file.parent.relative_to(folder).as_posix(): read_json(file) for file in files}
    gathered = {"kind": "inline", "must_understand": False, "metadata": members}
    text = json.dumps(root | {KEY: gathered})
    held = read_sums(folder) or {}
    sums = held | {METADATA: hashlib.sha256(text.encode()).hexdigest()}
    if root.get(KEY) == gathered and sums == held:  # a kill may have occurred between the two files
        return
    with atomic_files(folder / METADATA, folder / SUMS_FILE) as (metadata, listed):
        metadata.write_text(text, encoding="utf-8")
        listed.write_text(sums_text(sums), encoding="utf-8")


@dataclass(frozen=True, kw_only=True)
class RoomReport:
    """Summary of one generated room."""

    name: str
    num_sequences: int
    refused: tuple[tuple[int, str], ...]  # index of the sequence, reason why it does not fit the room


def generate_dataset(
    folder: Path,
    plan: DatasetPlan,
    config: RadarConfig,
    *,
    workers: int = 1,
    ray_address: str | None = None,
    listener: Callable[[RoomReport], object] | None = None,
    repair: bool = False,
    numbers: range | None = None,
) -> list[RoomReport]:
    """Generates the missing rooms; can be killed and called again.

    Args:
        folder: The data set.
        plan: Its plan.
        config: The radar.
        workers: Number of local processes. Default: 1.
        ray_address: Address of a Ray cluster, one task per core; "local" for an embedded one. Default: no Ray.
        listener: Called with the report of each finished room. Default: none.
        repair: Whether existing rooms are checked and damaged ones regenerated. Default: False.
        numbers: Numbers of the rooms that this machine makes (`DatasetPlan.part`). Default: all.

    Returns:
        Reports of the rooms that were generated in this call.

    Raises:
        InputError: If the folder has another plan, a package is missing, or a worker was killed.
    """
    check_packages(ray_address)
    if repair:
        with locked(folder):
            remove_damaged(folder, plan)
    open_dataset(folder, plan, config)
    sweep(resolved(folder), again=True)
    numbers = range(plan.num_rooms) if numbers is None else numbers
    done = finished(folder, map(plan.name_of, numbers))
    tasks = ((folder, plan, number, config) for number in numbers if plan.name_of(number) not in done)
    reports = []
    try:
        with _executor(workers, ray_address) as run:
            for report in run(tasks):
                reports.append(report)
                if listener is not None:
                    listener(report)
        names = [plan.name_of(number) for number in range(plan.num_rooms)]
        if len(finished(folder, names)) == len(names):
            with locked(folder):
                consolidate_rooms(resolved(folder), [] if plan.packed else names, AXES)
                write_rooms_card(resolved(folder), names, AXES)
    finally:
        sweep(resolved(folder), again=True)
    return reports


def check_packages(ray_address: str | None) -> None:
    """Raises InputError if a package that `generate_dataset` needs is missing."""
    if ray_address is None:
        need("dataset", "a data set", "zarr")
    else:
        need("cluster", "--ray-address")


Task = tuple[Path, DatasetPlan, int, RadarConfig]


def generate_one(task: Task) -> RoomReport:
    """Generates and writes one room on a single thread.

    Args:
        task: Folder, plan, number of the room, and radar.

    Returns:
        Summary of the room.
    """
    from threadpoolctl import threadpool_limits

    from mmweaver.datasets.room_generation import generate_room

    folder, plan, number, config = task
    spec = plan.room(number)
    how: dict[str, Any] = {"geometry_only": plan.geometry_only, "board": plan.board_of(spec, config)}
    with threadpool_limits(limits=1):
        if plan.geometry_only:  # small, and other machines would take a folder in which nothing changes for a leftover
            room = generate_room(spec, config, plan.num_frames, **how)
            with new_room(folder, spec.name, packed=plan.packed) as partial:
                _put_room(zarr_module().open_group(partial, mode="w"), room)
        else:
            with new_room(folder, spec.name, packed=plan.packed) as partial:
                group = zarr_module().open_group(partial, mode="w")
                cubes = _CubeWriter(group, config, len(spec.sequences), plan.num_frames)
                room = generate_room(spec, config, plan.num_frames, take_cube=cubes.add, **how)
                cubes.close()
                _put_room(group, room)
    return RoomReport(name=spec.name, num_sequences=len(room.sequences), refused=room.refused)


@contextmanager
def _executor(workers: int, ray_address: str | None) -> Iterator[Callable[[Iterable[Task]], Iterator[RoomReport]]]:
    if ray_address is not None:
        with _ray(workers, ray_address) as run:
            yield run
    elif workers == 1:
        yield lambda tasks: map(generate_one, tasks)
    else:
        with _processes(workers) as run:
            yield run


@contextmanager
def _processes(workers: int) -> Iterator[Callable[[Iterable[Task]], Iterator[RoomReport]]]:
    """Local processes. Raises InputError if one is killed, in which case multiprocessing.Pool would hang."""
    import multiprocessing
    from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool

    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"), initializer=_end_with_parent)

    def run(tasks: Iterable[Task]) -> Iterator[RoomReport]:
        try:
            waiting: set[Any] = set()
            for task in itertools.chain(tasks, [None] * AHEAD * workers):  # the rest only empties the queue
                if task is not None:
                    waiting.add(pool.submit(generate_one, task))
                if waiting and (task is None or len(waiting) == AHEAD * workers):
                    done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                    yield from (one.result() for one in done)
        except BrokenProcessPool:
            raise InputError(
                "a worker was killed, perhaps for want of memory; finished rooms are kept: the same command makes the"
                " rest, if need be with fewer --workers"
            ) from None

    try:
        yield run
    except BaseException:
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _end_with_parent() -> None:
    """Ends a worker silently when it is interrupted or its parent is killed."""
    import multiprocessing
    import signal
    import threading
    from multiprocessing.connection import wait

    signal.signal(signal.SIGINT, signal.SIG_DFL)
    parent = multiprocessing.parent_process()

    def watch() -> None:
        if parent is not None:
            wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _ray(workers: int, address: str) -> Iterator[Callable[[Iterable[Task]], Iterator[RoomReport]]]:
    """One task per room; a lost task is retried elsewhere, which is safe since rooms are written atomically."""
    import ray

    if address == "local":
        ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False, configure_logging=False)
    else:
        ray.init(address=address, log_to_driver=False)
    remote = ray.remote(num_cpus=1, max_retries=3)(generate_one)

    def run(tasks: Iterable[Task]) -> Iterator[RoomReport]:
        waiting: list[Any] = []
        ahead = AHEAD * max(workers, int(ray.cluster_resources().get("CPU", workers)))
        for task in itertools.chain(tasks, [None] * ahead):
            waiting += [] if task is None else [remote.remote(task)]
            if waiting and (task is None or len(waiting) == ahead):
                done, waiting = ray.wait(waiting)
                yield from ray.get(done)

    try:
        yield run
    finally:
        ray.shutdown()
