"""By night: what is built from the sdist is the same, and every line of the README runs in it as it stands, by a shell;
and the package runs in a new environment with its dependencies alone."""

import os
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

from tests.artifact.artifact import Installed, build, copy_sources, install
from tests.artifact.readme import extras_of_the_readme, recipes
from tests.artifact.test_wheel import expected_names, names_in


@pytest.fixture(scope="module")
def of_sdist(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel that is built from the sdist, as `python -m build` does, installed."""
    place = tmp_path_factory.mktemp("sdist")
    sdist = build(copy_sources(place / "tree"), "sdist", place / "sdist")
    with tarfile.open(sdist) as archive:
        archive.extractall(place / "unpacked", filter="data")
    (tree,) = (place / "unpacked").iterdir()
    return install(build(tree, "wheel", place / "wheel"), place / "site")


@pytest.mark.slow
def test_the_wheel_of_the_sdist_is_that_of_the_sources(of_sdist: Installed, installed: Installed):
    assert names_in(of_sdist) == names_in(installed) == expected_names()
    with zipfile.ZipFile(of_sdist.wheel) as first, zipfile.ZipFile(installed.wheel) as second:
        for name in names_in(installed):
            assert first.read(name) == second.read(name), name


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the lines of the README are for sh")
def test_every_line_of_the_readme_runs_in_a_shell(of_sdist: Installed, tmp_path: Path):
    """All shell of the page is one script, so that `cd` counts for the lines after it."""
    lines = "\n".join(one.text for one in recipes() if not one.is_python)
    code = "\n".join(one.text for one in recipes() if one.is_python)
    done = of_sdist.run(["sh", "-e"], tmp_path, extras=extras_of_the_readme(), given=lines)
    assert done.returncode == 0, done.stderr[-2000:]
    done = of_sdist.run([sys.executable, "-P", "-"], tmp_path, extras=[], given=code)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.slow
def test_the_package_runs_in_a_new_environment(installed: Installed, tmp_path: Path):
    """With its dependencies alone, as pip chooses them; skipped where there is no package index."""
    venv.create(tmp_path / "new", with_pip=True)
    programs = tmp_path / "new" / ("Scripts" if os.name == "nt" else "bin")
    outside = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    pip = [programs / "python", "-m", "pip", "--disable-pip-version-check"]
    reached = subprocess.run([*pip, "download", "--no-deps", "--dest", tmp_path / "probe", "tomli-w"],
                             capture_output=True, check=False, env=outside)  # fmt: skip
    if reached.returncode != 0:
        pytest.skip("no package index can be reached")
    subprocess.run([*pip, "install", "--quiet", installed.wheel], check=True, env=outside)
    for words in (["motion", "a person walks"], ["generate", "--demo"], ["sample", "room"]):
        done = subprocess.run(
            [programs / "mmweaver", *words], cwd=tmp_path, env=outside, capture_output=True, text=True, check=False
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "demo" / "preview.gif").is_file()
