"""Shared by all tests: one thread a process, checks of shapes, where real recordings lie."""

from __future__ import annotations

import os
import sys

# Before numpy and torch are imported, and for every process that a test starts: the bits are those of one thread, and
# several processes with several threads each are slower on every machine.
os.environ.update(
    OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", VECLIB_MAXIMUM_THREADS="1"
)  # fmt: skip

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from filelock import FileLock
from threadpoolctl import threadpool_limits

from tests import shape_checks
from tests.cpu_summary import CpuSummary

if TYPE_CHECKING:
    from mmweaver.core.board import Board
    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.core.records import RadarCube, RgbdPhoto, Scene

# Many tests start processes, which would each compile the package anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

threadpool_limits(1)  # of numpy, which a plugin has imported already
shape_checks.check_first_calls()
REAL_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--check-every-call", action="store_true", help="check the shapes of all calls, not of the first")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(CpuSummary())
    if config.getoption("--check-every-call"):
        shape_checks.check_every_call()


@pytest.fixture(scope="module", autouse=True)
def shapes_checked_anew() -> None:
    """The first calls of every function are checked in every file of tests."""
    shape_checks.next_file()


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real recordings; the test is skipped where it is absent."""
    if not REAL_DATA.is_dir():
        pytest.skip(f"no real recordings here: {REAL_DATA} is absent")
    return REAL_DATA


@pytest.fixture
def blank_training_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trainings write blank pictures: a sheet of matplotlib costs a second at every validation.

    What is drawn is tested in test_validation_sheet.py; by night tests/cli/test_train.py
    draws it in a whole run.
    """
    for module, name in (
        ("mmweaver.training.network_training", "draw_sheet"), ("mmweaver.training.activity_training", "draw_confusion"),
        ("mmweaver.training.hypernetwork_training", "draw_sheet"),
    ):  # fmt: skip
        monkeypatch.setattr(f"{module}.{name}", lambda *_, **__: np.zeros((2, 2, 3), np.uint8))


@pytest.fixture(scope="session", autouse=True)
def rooms_are_reconstructed_once() -> Iterator[None]:
    """A photo that this process has reconstructed before gives the same scene, and the network encodes it once.

    That saves 0.7 CPU seconds in each of many tests. Tests of the reconstruction and of the network themselves call
    `reconstruct` and `LearnedRoom`, which stay as they are.
    """
    from mmweaver.models.methods import Learned
    from mmweaver.scene.reconstruction import reconstruct
    from mmweaver.weaver import room_reader

    scenes: dict[str, Scene] = {}

    def once(photo: RgbdPhoto, others: Any = (), *, assumptions: tuple[str, ...] = ()) -> Scene:
        if others:
            return reconstruct(photo, others, assumptions=assumptions)
        digest = hashlib.sha256(repr((photo.intrinsics, assumptions)).encode())
        for array in (photo.rgb, photo.depth_m, *(() if photo.classes is None else (photo.classes.index,))):
            digest.update(repr((array.shape, array.dtype)).encode() + np.ascontiguousarray(array).tobytes())
        key = digest.hexdigest() + repr(None if photo.classes is None else photo.classes.names)
        if key not in scenes:
            scenes[key] = reconstruct(photo, assumptions=assumptions)
        return scenes[key]

    encode = Learned._encode
    encoded: dict[Any, tuple[Scene, Any]] = {}

    def encoded_once(
        self: Learned, scene: Scene, config: RadarConfig, background: RadarCube | None, board: Board | None
    ) -> Any:
        if self.weights is not None or background is not None:
            return encode(self, scene, config, background, board)
        key = id(scene), config, self.propagation, None if board is None else board.digest
        if key not in encoded:
            encoded[key] = scene, encode(self, scene, config, None, board)  # the scene is kept, so its id stays its own
        return encoded[key][1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room_reader, "reconstruct", once)
        patch.setattr(Learned, "_encode", encoded_once)
        yield


@pytest.fixture(scope="session")
def tiny_signals(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tiny data set with its signals; shared by all tests, so nobody writes into it."""
    return _made_once(tmp_path_factory, "signals", geometry_only=False)


@pytest.fixture(scope="session")
def tiny_geometry(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tiny data set without signals; shared by all tests, so nobody writes into it."""
    return _made_once(tmp_path_factory, "geometry", geometry_only=True)


def _made_once(factory: pytest.TempPathFactory, name: str, *, geometry_only: bool) -> Path:
    """By the first worker of pytest-xdist that asks for it; the others wait."""
    pytest.importorskip("zarr")
    is_worker = "PYTEST_XDIST_WORKER" in os.environ
    folder = (factory.getbasetemp().parent if is_worker else factory.getbasetemp()) / "tiny" / name
    folder.parent.mkdir(exist_ok=True)
    from tests.training.tiny_data import tiny_data

    with FileLock(f"{folder}.lock"):
        return tiny_data(folder, geometry_only=geometry_only)
