"""What the README tells a reader to type runs in an empty folder, by the wheel that was built and installed.

In `make test` all of it runs in one process and smaller where SMALLER says so; by night a shell runs every line as it
stands (test_sdist.py).
"""

import json
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.artifact.artifact import Installed
from tests.artifact.readme import PAGE, Recipe, recipes

RUNNER = Path(__file__).parent / "run_recipes.py"
# Parts of recipes that take long, and what runs in their place.
SMALLER = {
    "--rooms living_room,office --layouts 1 --sequences 4": "--rooms office --layouts 1 --sequences 1 --frames 3",
    "--activities activities.toml --each 10": "--activities activities.toml --each 2 --seconds 1",
    "recognise train TASK.toml --quick": "recognise train TASK.toml --sequences 2",
    "--out walk/ --seed 0": "--out walk/ --seed 0 --no-pictures --frames 5",
    "--out board/": "--out board/ --no-pictures",
    "--out left/": "--out left/ --no-pictures --frames 5",
    "--out empty/": "--out empty/ --no-pictures --no-analysis",
    "overwrite=True)": "overwrite=True, pictures=False)",
}


def smaller(recipe: Recipe) -> Recipe:
    """A recipe with everything replaced that SMALLER names."""
    text = recipe.text
    for part, instead in SMALLER.items():
        text = text.replace(part, instead)
    return Recipe(text, recipe.is_python)


def extras_of_the_readme() -> list[str]:
    """The extras that the page tells a reader to install."""
    named = re.findall(r"pip install 'mmweaver\[([\w,]+)\]'", PAGE.read_text(encoding="utf-8"))
    return sorted({extra for group in named for extra in group.split(",")})


@pytest.fixture(scope="module")
def carried_out(installed: Installed, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """The folder in which all recipes ran, with no packages but those that the page names, and what each printed."""
    place = tmp_path_factory.mktemp("reader")
    all_recipes = [smaller(one) for one in recipes()]
    given = json.dumps([[one.text, one.is_python, [] if one.is_python else one.commands] for one in all_recipes])
    done = installed.run([sys.executable, "-P", RUNNER], place, extras=extras_of_the_readme(), given=given)
    assert done.returncode == 0, done.stderr[-2000:]
    commands = [
        " ".join(words) for one in all_recipes if not one.is_python for words in one.commands if words[0] != "cd"
    ]
    return place, dict(zip(commands, json.loads(done.stdout.splitlines()[-1]), strict=True))


def test_every_line_of_the_readme_runs(carried_out: tuple[Path, dict[str, str]]):
    place, printed = carried_out
    outputs = [word for line in printed for word in re.findall(r"--out (\S+)|dataset (\S+)|sample (\S+)", line)]
    names = ["".join(groups).rstrip("/") for groups in outputs]
    assert len(names) >= 9
    for name in names:
        (found,) = {path for path in (place / name, place / "room" / name) if path.exists()}
        assert found.is_file() or any(found.iterdir())


def test_the_demo_is_drawn(carried_out: tuple[Path, dict[str, str]]):
    place, _ = carried_out
    with Image.open(place / "demo" / "preview.png") as picture:
        assert min(picture.size) > 500
        assert np.asarray(picture.convert("L")).std() > 20
    with Image.open(place / "demo" / "preview.gif") as moving:
        assert getattr(moving, "n_frames", 1) > 10


def test_the_recogniser_of_the_readme_names_an_activity_of_its_task(carried_out: tuple[Path, dict[str, str]]):
    place, printed = carried_out
    (said,) = [text for line, text in printed.items() if "recognise run" in line]
    labels = tomllib.loads((place / "room" / "TASK.toml").read_text())["activities"]
    assert said.split()[2] in labels


def test_what_is_smaller_stands_in_the_readme_once():
    text = "\n".join(one.text for one in recipes())
    for part in SMALLER:
        assert text.count(part) == 1, part


def test_the_readme_has_recipes_of_both_kinds():
    found = recipes()
    assert sum(one.is_python for one in found) >= 1
    assert sum(not one.is_python for one in found) >= 10


def test_the_command_runs_as_pip_installs_it(installed: Installed, elsewhere: Path):
    done = installed.run([installed.script, "motion", "a person walks"], elsewhere, extras=[])
    assert done.returncode == 0, done.stderr
    assert "walking" in done.stdout
    assert not any(elsewhere.iterdir())


def test_every_command_has_a_help(installed: Installed, elsewhere: Path):
    listed = installed.run([sys.executable, "-P", "-m", "mmweaver", "--help"], elsewhere, extras=[])
    names = re.findall(r"^    (\w+)(?: |$)", listed.stdout, re.MULTILINE)
    assert len(names) > 20
    given = json.dumps([["", False, [["mmweaver", name, "--help"] for name in names]]])
    done = installed.run([sys.executable, "-P", RUNNER], elsewhere, extras=[], given=given)
    assert done.returncode == 0, done.stderr
    for name, text in zip(names, json.loads(done.stdout), strict=True):
        assert text.startswith(f"usage: mmweaver {name} "), name
