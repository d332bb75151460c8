"""What the wheel holds: the package with the files it needs, no study, at most 17.6 MB."""

import re
import subprocess
import sys
import tomllib
import zipfile
import zlib
from pathlib import Path

import pytest
from setuptools import find_packages

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "src" / "mmweaver"
LARGEST_BYTES = 17_600_000


def packaged_files() -> list[Path]:
    """Files that the patterns of pyproject.toml put into the wheel."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    assert settings["packages"]["find"]["where"] == ["src"]
    data = [path for pattern in settings["package-data"]["mmweaver"] for path in PACKAGE.glob(pattern)]
    return [*PACKAGE.rglob("*.py"), *(path for path in data if path.is_file())]


def test_the_wheel_holds_what_it_needs_and_no_study():
    names = {path.relative_to(PACKAGE).as_posix() for path in packaged_files()}
    needed = {
        "py.typed", "weights/weaver.safetensors", "weights/segmenter.safetensors", "sample/rgb.webp",
    }  # fmt: skip
    assert needed <= names
    assert not any("motiongpt_small" in name for name in names)
    assert {name.partition(".")[0] for name in find_packages(str(ROOT / "src"))} == {"mmweaver"}
    for path in packaged_files():
        if path.suffix == ".py":
            assert not re.search(r"^\s*(from|import) studies\b", path.read_text(), re.MULTILINE), path


def test_the_wheel_is_small_enough():
    """Compressed as a wheel is; its own records take less than the margin."""
    compressed = sum(len(zlib.compress(path.read_bytes(), 6)) for path in packaged_files())
    assert compressed < LARGEST_BYTES - 200_000


@pytest.mark.slow
def test_a_wheel_that_was_built_holds_the_same(tmp_path: Path):
    """The fast tests above read the patterns and weigh their files; this one builds."""
    command = [sys.executable, "-m", "pip", "wheel", str(ROOT), "--no-deps", "--no-build-isolation", "--quiet",
               "--wheel-dir", str(tmp_path)]  # fmt: skip
    subprocess.run(command, check=True, cwd=tmp_path)
    (wheel,) = tmp_path.glob("*.whl")
    assert wheel.stat().st_size < LARGEST_BYTES
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert names == {path.relative_to(ROOT / "src").as_posix() for path in packaged_files()}
