"""Rooms as one file each: the same data, plain zarr reads it, damage is noticed, machines share the work, kills."""

import copy
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.packed_folder import PackedPath, pack_folder
from mmweaver.core.staging import is_staged
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset
from mmweaver.datasets.verification import verify
from tests.datasets.test_generate_rooms import contents

zarr = pytest.importorskip("zarr")
PLAN = DatasetPlan(
    kinds=("office", "living_room"), lightings=("day",), num_layouts=1, sequences_a_room=1, num_frames=2,
    geometry_only=True, packed=True,
)  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "set"
    generate_dataset(folder, PLAN, AWR1843)
    return folder


@pytest.mark.slow  # the tests below read packed rooms, too
def test_a_packed_set_holds_the_same_in_a_file_per_room(folder: Path, tmp_path: Path):
    plain = tmp_path / "plain"
    generate_dataset(plain, replace(PLAN, packed=False), AWR1843)
    assert len(list(folder.glob("*.zip"))) == 2
    assert not any(one.is_dir() and one.name.startswith(("office", "living")) for one in folder.iterdir())
    for packed, room in zip(read_rooms(folder), read_rooms(plain), strict=True):
        assert len(room.text) > 0
        assert np.array_equal(packed.seed, room.seed)
        assert np.array_equal(packed.photo.depth_m, room.photo.depth_m, equal_nan=True)
        assert np.array_equal(packed.cube(0).values, room.cube(0).values)
        again = copy.deepcopy(packed)  # as a loader's process gets it, by pickling
        assert np.array_equal(again.cube(0).values, room.cube(0).values)


def test_plain_zarr_and_xarray_read_a_packed_room(folder: Path):
    xarray = pytest.importorskip("xarray")
    store = zarr.storage.ZipStore(folder / "office_000.zip", mode="r")
    group = zarr.open_group(store, mode="r")
    (room,) = (one for one in read_rooms(folder) if one.files.folder.name == "office_000.zip")
    assert np.array_equal(group["joints_m"][...], room.joints_m)
    opened = xarray.open_zarr(zarr.storage.ZipStore(folder / "office_000.zip", mode="r"), consolidated=False)
    assert np.array_equal(opened["seed"].values, room.seed)


@pytest.mark.parametrize("share", [0.1, 0.9])
def test_a_changed_byte_is_noticed_and_repaired(folder: Path, share: float, tmp_path: Path):
    again = tmp_path / "again"
    shutil.copytree(folder, again)
    file = again / "office_000.zip"
    data = bytearray(file.read_bytes())
    data[int(share * len(data))] ^= 0xFF
    file.write_bytes(data)
    found = verify(again)
    assert {str(one.file).partition(".zip")[0] for one in found.damaged} == {str(again / "office_000")}
    assert "--packed" in found.commands[0]
    generate_dataset(again, PLAN, AWR1843, repair=True)
    assert contents(again) == contents(folder)


def test_two_machines_make_their_parts_and_a_third_run_finds_nothing_to_do(folder: Path, tmp_path: Path):
    again = tmp_path / "again"
    second = generate_dataset(again, PLAN, AWR1843, numbers=PLAN.part(2, 2))
    assert [one.name for one in second] == ["living_room_000"]
    with pytest.raises(InputError, match="not complete"):
        read_rooms(again)
    assert len(generate_dataset(again, PLAN, AWR1843, numbers=PLAN.part(1, 2))) == 1
    assert contents(again) == contents(folder)
    assert generate_dataset(again, PLAN, AWR1843) == []


def test_a_killed_run_loses_no_finished_room_and_is_resumed_to_the_same_bytes(folder: Path, tmp_path: Path):
    """The process is killed as soon as its first room is there, while it makes the second."""
    again = tmp_path / "again"
    words = ["--rooms", "office,living_room", "--layouts", "1", "--sequences", "1", "--frames", "2", "--packed",
             "--geometry-only", "--quiet"]  # fmt: skip
    command = [sys.executable, "-m", "mmweaver", "dataset", str(again), *words]
    process = subprocess.Popen(command)
    while not (again / "office_000.zip").is_file() and process.poll() is None:
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = {file.name: file.stat().st_mtime_ns for file in again.glob("*.zip") if not is_staged(file.name)}
    assert set(kept) == {"office_000.zip"}
    subprocess.run(command, check=True)
    assert {name: (again / name).stat().st_mtime_ns for name in kept} == kept
    assert not [one.name for one in again.iterdir() if is_staged(one.name)]
    names = {file.name for file in folder.glob("*.zip")}
    assert {file.name for file in again.glob("*.zip")} == names
    for one, other in zip(read_rooms(again), read_rooms(folder), strict=True):
        assert np.array_equal(one.cube(0).values, other.cube(0).values)


def test_a_zip_of_others_is_refused_in_one_line(tmp_path: Path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.txt").write_text("words " * 100)
    pack_folder(tmp_path / "in", tmp_path / "fine.zip")
    assert bytes((PackedPath(tmp_path / "fine.zip") / "a.txt").data()) == (tmp_path / "in" / "a.txt").read_bytes()
    shutil.make_archive(str(tmp_path / "deflated"), "zip", tmp_path / "in")
    for name, what in (("deflated.zip", "is compressed"), ("none.zip", "no regular file")):
        with pytest.raises(InputError, match=what):
            (PackedPath(tmp_path / name) / "a.txt").data()
    (tmp_path / "cut.zip").write_bytes((tmp_path / "fine.zip").read_bytes()[:-40])
    os.mkfifo(tmp_path / "pipe.zip")
    for name in ("cut.zip", "pipe.zip"):
        with pytest.raises(InputError):
            PackedPath(tmp_path / name).is_dir() and (PackedPath(tmp_path / name) / "a.txt").data()
