"""What the README tells a reader to type runs in an empty folder, by the wheel that was built and installed.

In `make test` all of it runs in one process and smaller where smaller.py says so; by night a shell runs every line as it
stands (test_sdist.py).
"""

import json
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
from PIL import Image

from tests.artifact.artifact import Installed
from tests.artifact.conftest import RECIPE_RUNNER
from tests.artifact.readme import recipes
from tests.artifact.smaller import SMALLER


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
    assert any(one.is_python for one in found)
    assert sum(not one.is_python for one in found) >= 10


def test_the_command_runs_as_pip_installs_it(installed: Installed, tmp_path: Path):
    done = installed.run([installed.script, "motion", "a person walks"], tmp_path, extras=[])
    assert done.returncode == 0, done.stderr
    assert "walking" in done.stdout
    assert not any(tmp_path.iterdir())


def test_every_command_has_a_help(installed: Installed, tmp_path: Path):
    listed = installed.run([sys.executable, "-P", "-m", "mmweaver", "--help"], tmp_path, extras=[])
    names = re.findall(r"^    (\w+)(?: |$)", listed.stdout, re.MULTILINE)
    assert len(names) > 20
    given = json.dumps([["", False, [["mmweaver", name, "--help"] for name in names]]])
    done = installed.run([sys.executable, "-P", RECIPE_RUNNER], tmp_path, extras=[], given=given)
    assert done.returncode == 0, done.stderr
    for name, text in zip(names, json.loads(done.stdout), strict=True):
        assert text.startswith(f"usage: mmweaver {name} "), name
