"""Generates the missing rooms of a data set on the cores of this machine or on a Ray cluster."""

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.board import Board
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import resolved
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.staging import sweep
from mmweaver.datasets.data_card import write_rooms_card
from mmweaver.datasets.dataset_plan import DatasetPlan, RoomSpec
from mmweaver.datasets.dataset_store import is_done
from mmweaver.datasets.dataset_writer import AXES, consolidate_rooms, open_dataset, remove_damaged, write_room


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

    Returns:
        Reports of the rooms that were generated in this call.

    Raises:
        InputError: If the folder has another plan, a package is missing, or a worker was killed.
    """
    check_packages(ray_address)
    rooms = plan.rooms()
    if repair:
        remove_damaged(folder, plan)
    open_dataset(folder, plan, config)
    sweep(resolved(folder), again=True)
    missing = [room for room in rooms if not is_done(folder, room.name)]
    boards = {room.name: plan.board_of(room, config) for room in missing}
    tasks = ((folder, room, config, plan.num_frames, plan.geometry_only, boards[room.name]) for room in missing)
    reports = []
    try:
        with _executor(workers, ray_address) as run:
            for report in run(tasks):
                reports.append(report)
                if listener is not None:
                    listener(report)
        names = [room.name for room in rooms]
        if all(is_done(folder, name) for name in names):
            consolidate_rooms(resolved(folder), names, AXES)
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


Task = tuple[Path, RoomSpec, RadarConfig, int, bool, Board]


def generate_one(task: Task) -> RoomReport:
    """Generates and writes one room on a single thread.

    Args:
        task: Folder, room, radar, frames per sequence, whether only geometry is stored, and board.

    Returns:
        Summary of the room.
    """
    from threadpoolctl import threadpool_limits

    from mmweaver.datasets.room_generation import generate_room

    folder, spec, config, num_frames, geometry_only, board = task
    with threadpool_limits(limits=1):
        room = generate_room(spec, config, num_frames, geometry_only=geometry_only, board=board)
    write_room(folder, room)
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
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from concurrent.futures.process import BrokenProcessPool

    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"), initializer=_end_with_parent)

    def run(tasks: Iterable[Task]) -> Iterator[RoomReport]:
        try:
            for done in as_completed([pool.submit(generate_one, task) for task in tasks]):
                yield done.result()
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
        waiting = [remote.remote(task) for task in tasks]
        while waiting:
            done, waiting = ray.wait(waiting)
            yield from ray.get(done)

    try:
        yield run
    finally:
        ray.shutdown()
