"""The wheel, built and installed once for all tests of this folder."""

import os
from pathlib import Path

import pytest
from filelock import FileLock

from tests.artifact.artifact import Installed, build, copy_sources, install


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """By the first worker of pytest-xdist that asks for it; the others wait. Nobody writes into it."""
    base = tmp_path_factory.getbasetemp()
    place = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "artifact"
    place.mkdir(exist_ok=True)
    with FileLock(place / "lock"):
        if not (place / "done").exists():
            install(build(copy_sources(place / "tree"), "wheel", place / "wheel"), place / "site")
            (place / "done").touch()
    (wheel,) = (place / "wheel").iterdir()
    return Installed(wheel, place / "site")


@pytest.fixture
def elsewhere(tmp_path: Path) -> Path:
    """An empty working directory, outside the repository."""
    return tmp_path
