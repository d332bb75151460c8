"""The wheel, built and installed once for all tests of this folder, and what the recipes of the README left."""

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from filelock import FileLock

from mmweaver.cli.main import COMMANDS
from tests.artifact.artifact import Installed, build, copy_sources, install
from tests.artifact.readme import Recipe, extras_of_the_readme, recipes
from tests.artifact.smaller import smaller

RECIPE_RUNNER = Path(__file__).parent / "run_recipes.py"


def _once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder that the first worker of pytest-xdist to ask for it makes; the others wait. Nobody writes into it."""
    base = factory.getbasetemp()
    place = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / f"artifact_{name}"
    place.mkdir(exist_ok=True)
    with FileLock(place / "lock"):
        if not (place / "done").exists():
            make(place)
            (place / "done").touch()
    return place


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel, installed."""
    place = _once(
        tmp_path_factory, "wheel",
        lambda place: install(build(copy_sources(place / "tree"), "wheel", place / "wheel"), place / "site"),
    )  # fmt: skip
    (wheel,) = (place / "wheel").iterdir()
    return Installed(wheel, place / "site")


@pytest.fixture(scope="session")
def carried_out(installed: Installed, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """The folder in which all recipes ran, and the help of all commands, and what each printed.

    There were no packages but the dependencies and those of the extras that the page names.
    """

    def run_all(place: Path) -> None:
        given = [*map(smaller, recipes()), *(Recipe(f"mmweaver {name} --help") for name in COMMANDS)]
        words = json.dumps([[one.text, one.is_python, one.commands] for one in given])
        (place / "reader").mkdir()
        done = installed.run(
            [sys.executable, "-P", RECIPE_RUNNER], place / "reader", extras=extras_of_the_readme(), given=words
        )
        assert done.returncode == 0, done.stderr[-2000:]
        commands = [" ".join(words) for one in given for words in one.commands if words[0] != "cd"]
        printed = dict(zip(commands, json.loads(done.stdout.splitlines()[-1]), strict=True))
        (place / "printed.json").write_text(json.dumps(printed), encoding="utf-8")

    place = _once(tmp_path_factory, "recipes", run_all)
    return place / "reader", json.loads((place / "printed.json").read_text(encoding="utf-8"))
