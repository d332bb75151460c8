"""A power cut: nothing has its name before its bytes are on the disk, and what is reported as written stays there."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

if not sys.platform.startswith("linux"):
    pytest.skip("open files are named by /proc", allow_module_level=True)

from mmweaver.cli.main import main
from mmweaver.core.atomic_files import create_once
from mmweaver.core.boards import AWR1843
from mmweaver.datasets import room_generation
from mmweaver.datasets.dataset_plan import DatasetPlan
from mmweaver.datasets.generate_rooms import generate_dataset
from mmweaver.datasets.room_generation import GeneratedRoom
from mmweaver.io.npz_files import write_radar_npz
from mmweaver.io.result_folder import save_results
from mmweaver.io.stream_folder import LIST, StreamFolder
from tests.compression.echoes import SMALL, crowd
from tests.faults.synced_disk import SyncedDisk
from tests.io.test_stream_folder import add
from tests.motion.rooms import room
from tests.viz.views import noise_view


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short cube, and the same as a .mmw file."""
    folder = tmp_path_factory.mktemp("recording")
    write_radar_npz(folder / "radar.npz", crowd())
    (folder / "radar.json").write_text(SMALL.to_json())
    assert main(["compress", str(folder / "radar.npz"), "-o", str(folder / "a.mmw"), "--bytes", "3000", "--quiet"]) == 0
    return folder


def results(out: Path, **how: bool) -> None:
    save_results(out, noise_view(frames=2), {"seed": 0}, extra={"request.toml": "seed = 0\n"}, **how)


def new_results(folder: Path, _: Path) -> None:
    results(folder / "new" / "walk")


def other_results(folder: Path, _: Path) -> None:
    """Into a folder that holds others, and into one that holds nothing."""
    (folder / "empty").mkdir()
    for out in (folder, folder / "empty", folder):
        results(out, overwrite=True)


def files(folder: Path, recording: Path) -> None:
    """A .mmw file, and two files that belong together, in folders that are not there yet."""
    mmw, cube = folder / "new" / "a.mmw", folder / "decoded" / "here" / "radar.npz"
    assert main(["compress", str(recording / "radar.npz"), "-o", str(mmw), "--bytes", "3000", "--quiet"]) == 0
    assert main(["decompress", str(recording / "a.mmw"), "-o", str(cube), "--quiet"]) == 0


def appended(folder: Path, recording: Path) -> None:
    """To a file that begins so, and once more."""
    words = ["compress", str(recording / "radar.npz"), "-o", str(folder / "a.mmw"), "--append", "--preset", "fast"]
    for _ in range(2):
        assert main([*words, "--bytes", "3000", "--quiet"]) == 0


def plan(folder: Path, _: Path) -> None:
    create_once(folder / "new" / "plan.json", "{}")


def dataset(folder: Path, _: Path) -> None:
    """Two rooms without sequences: how signals are made is no part of this."""
    clutter = np.zeros((AWR1843.num_range_bins, AWR1843.num_antennas), np.complex64)
    photo = room().photo

    def empty(spec: object, *_: object, **__: object) -> GeneratedRoom:
        return GeneratedRoom(spec=spec, photo=photo, static=clutter, sequences=(), refused=())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room_generation, "generate_room", empty)
        what = DatasetPlan(kinds=("office",), lightings=("day",), num_layouts=2, sequences_a_room=1, num_frames=2)
        generate_dataset(folder / "new" / "data", what, AWR1843)


@pytest.mark.parametrize("write", [new_results, other_results, files, appended, plan, dataset])
def test_what_is_written_is_on_the_disk(write: Callable[[Path, Path], None], tmp_path: Path, recording: Path):
    disk = SyncedDisk()
    with disk.recorded():
        write(tmp_path, recording)
    assert disk.early == []
    assert any(path.is_file() for path in tmp_path.rglob("*"))
    assert disk.lost(tmp_path) == []


def test_a_stream_is_on_the_disk_part_by_part(tmp_path: Path):
    """But parts.jsonl, a log whose last line a reader may find cut short."""
    disk = SyncedDisk(LIST)
    with disk.recorded():
        folder = StreamFolder(tmp_path / "new" / "live", {"seed": 0})
        for first in (0, 3):
            add(folder, first, 3)
            assert disk.lost(tmp_path) == []
        folder.finish()
    assert disk.early == disk.lost(tmp_path) == []
