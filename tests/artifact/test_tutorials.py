"""Each tutorial runs from its first line to its last in an empty folder, by the installed wheel."""

import json
import sys
from pathlib import Path

import pytest

from tests.artifact.artifact import Installed
from tests.artifact.conftest import RECIPE_RUNNER
from tests.artifact.readme import TUTORIALS, extras_of_the_readme, recipes


def test_there_are_six_short_ones():
    assert len(TUTORIALS) == 6
    assert all(len(page.read_text(encoding="utf-8").split()) <= 800 for page in TUTORIALS)


@pytest.mark.slow  # the recipes of the README, which run in `make test`, are much the same
@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_tutorial_runs(installed: Installed, tmp_path: Path, page: Path):
    given = recipes(page)
    assert given
    words = json.dumps([[one.text, one.is_python, one.commands] for one in given])
    done = installed.run([sys.executable, "-P", RECIPE_RUNNER], tmp_path, extras=extras_of_the_readme(), given=words)
    assert done.returncode == 0, done.stderr[-2000:]
    assert page.stem == "install" or any(tmp_path.iterdir())
