"""A small data set: complete, reproducible, and safe from a kill."""

import hashlib
import json
import os
import shutil
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.staging import staging_path
from mmweaver.datasets import generate_rooms
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.dataset_store import PLAN_FILE, read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset, generate_one, open_dataset

zarr = pytest.importorskip("zarr")
PLAN = DatasetPlan(kinds=("office",), lightings=("day",), num_layouts=2, sequences_a_room=2, num_frames=2)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "set"
    generate_dataset(folder, PLAN, AWR1843)
    return folder


def test_it_reads_with_plain_zarr_and_its_axes_have_units(folder: Path):
    root = zarr.open_group(folder, mode="r")
    assert root["range"].attrs["units"] == "m"
    iq = root["office_000"]["iq"]
    assert iq.metadata.dimension_names == ("sequence", "frame_time", "range", "radial_velocity", "antenna", "part")
    assert iq.dtype == np.float16
    assert iq.shape[1:] == (2, 64, 32, 12, 2)
    assert json.loads((folder / PLAN_FILE).read_text())["seed"] == 0


def test_half_precision_keeps_the_noise(folder: Path):
    room = read_rooms(folder)[0]
    cube = room.cube(0)
    assert np.isfinite(cube.values).all()
    noise = np.median(np.abs(cube.values) ** 2)
    expected = AWR1843.noise_power_mw * 1.5 / AWR1843.num_samples * 1.5 / AWR1843.num_loops * np.log(2)
    assert 10 * np.log10(noise / expected) == pytest.approx(0, abs=1.5)


def test_after_a_kill_the_rest_is_generated_bit_by_bit(folder: Path, tmp_path: Path):
    again = tmp_path / "again"
    shutil.copytree(folder, again)
    shutil.rmtree(again / "office_001")
    living = staging_path(again / "office_001")
    dead = living.with_name(living.name.replace(f"-{os.getpid()}-", "-4000000-"))
    for partial in (dead, living):  # what a killed process leaves, and what a worker that outlives it still writes
        partial.mkdir()
    reports = generate_dataset(again, PLAN, AWR1843)
    assert [report.name for report in reports] == ["office_001"]
    assert not dead.exists()
    assert living.exists()
    shutil.rmtree(living)
    for first, second in zip(read_rooms(folder), read_rooms(again), strict=True):
        assert len(first.text) == len(second.text) > 0
        for index in range(len(first.text)):
            assert np.array_equal(first.cube(index).values, second.cube(index).values)
        assert np.array_equal(first.joints_m, second.joints_m)
        assert np.array_equal(first.photo.rgb, second.photo.rgb)
    assert generate_dataset(again, PLAN, AWR1843) == []


def test_another_plan_and_a_full_folder_are_refused(folder: Path, tmp_path: Path):
    other = DatasetPlan(kinds=("office",), lightings=("day",), num_layouts=2, sequences_a_room=2, num_frames=5)
    with pytest.raises(InputError, match="another plan"):
        generate_dataset(folder, other, AWR1843)
    (tmp_path / "mine.txt").write_text("keep me")
    with pytest.raises(InputError, match="not empty"):
        generate_dataset(tmp_path, PLAN, AWR1843)
    assert (tmp_path / "mine.txt").read_text() == "keep me"
    with pytest.raises(InputError, match="no data set"):
        read_rooms(tmp_path)


def test_a_room_written_in_the_meantime_is_kept(folder: Path, tmp_path: Path):
    again = tmp_path / "again"
    shutil.copytree(folder, again)
    before = (again / "office_000" / "zarr.json").stat().st_mtime_ns
    generate_one((again, PLAN, 0, AWR1843))
    assert (again / "office_000" / "zarr.json").stat().st_mtime_ns == before
    assert not list(again.glob(".office*"))


def contents(folder: Path) -> dict[str, str]:
    """{file: its sha256}."""
    files = (file for file in sorted(folder.rglob("*")) if file.is_file())
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def test_a_set_begun_and_killed_at_once_is_resumed(folder: Path, tmp_path: Path):
    """Whatever part of the root is there, an empty folder included, the same command completes it to the bit."""
    root = [PLAN_FILE, "zarr.json", "SHA256SUMS", "range"]
    open_dataset(tmp_path / "begun", PLAN, AWR1843)
    for count in range(len(root) + 1):
        part = tmp_path / f"part_{count}"
        part.mkdir()
        for name in root[:count]:
            copy = shutil.copytree if (folder / name).is_dir() else shutil.copy
            copy(folder / name, part / name)
        if count == 4:
            (part / "SHA256SUMS").unlink()
            shutil.rmtree(part / "range" / "c")
        if count == 3:  # a list of checksums is written last: what it lists was there, and is damaged
            with pytest.raises(InputError, match="--repair"):
                open_dataset(part, PLAN, AWR1843)
            continue
        open_dataset(part, PLAN, AWR1843)
        assert contents(part) == contents(tmp_path / "begun")


def test_a_killed_worker_is_one_line_and_not_a_wait_for_ever(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(generate_rooms, "generate_one", _kill_myself)
    with pytest.raises(InputError, match="a worker was killed"):
        generate_dataset(tmp_path / "set", replace(PLAN, num_layouts=1), AWR1843, workers=2)


def _kill_myself(task: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)
