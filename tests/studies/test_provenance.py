"""Where a result comes from: this repository's commit, and no other's."""

import os
import subprocess
from pathlib import Path

import pytest

from mmweaver.core.constants import __version__
from studies.manifest import hardware, provenance


def git(root: Path, *words: str) -> str:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    environment |= {f"GIT_{who}_{what}": "a@b" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    done = subprocess.run(["git", *words], cwd=root, check=True, capture_output=True, text=True, env=environment)
    return done.stdout.strip()


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """A repository that looks like mmWeaver's."""
    for file in ("src/mmweaver/__init__.py", "studies/__init__.py", "README.md"):
        path = tmp_path / "clone" / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    root = tmp_path / "clone"
    git(root, "init", "--quiet")
    git(root, "add", "--all")
    git(root, "commit", "--quiet", "--message", "first")
    return root


def test_a_clean_clone_gives_its_commit(clone: Path):
    found = provenance(clone, clone / "src" / "mmweaver")
    assert found == {
        "mmweaver_version": __version__, "commit": git(clone, "rev-parse", "--short=12", "HEAD"), "dirty": False
    }  # fmt: skip


@pytest.mark.parametrize(("file", "is_dirty"), [("studies/new.py", True), ("README.md", False)])
def test_a_change_in_package_or_studies_is_dirty_in_a_page_not(clone: Path, file: str, is_dirty: bool):
    (clone / file).write_text("changed = True\n")
    assert provenance(clone, clone / "src" / "mmweaver")["dirty"] is is_dirty


def test_the_commit_of_another_repository_is_never_recorded(clone: Path, tmp_path: Path):
    """A copy of mmWeaver that was vendored into the repository of something else."""
    other = tmp_path / "other"
    (other / "vendored").mkdir(parents=True)
    for file in ("src/mmweaver/__init__.py", "studies/__init__.py"):
        path = other / "vendored" / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    git(other, "init", "--quiet")
    git(other, "add", "--all")
    git(other, "commit", "--quiet", "--message", "foreign")
    found = provenance(other / "vendored", other / "vendored" / "src" / "mmweaver")
    assert found["commit"] is None
    assert "not mmWeaver's" in found["commit_unknown"]


def test_a_package_from_elsewhere_has_no_commit(clone: Path, tmp_path: Path):
    found = provenance(clone, tmp_path / "site-packages" / "mmweaver")
    assert found["commit"] is None
    assert "imported mmweaver" in found["commit_unknown"]


def test_without_git_the_reason_is_given(clone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    outside = tmp_path / "outside"
    outside.mkdir()
    assert "not in a git repository" in provenance(outside, outside)["commit_unknown"]
    monkeypatch.setenv("PATH", str(tmp_path))
    assert "git is not installed" in provenance(clone, clone / "src" / "mmweaver")["commit_unknown"]


def test_git_variables_do_not_mislead(clone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "nowhere"))
    assert provenance(clone, clone / "src" / "mmweaver")["dirty"] is False


def test_hardware_has_the_threads_that_are_used():
    import torch

    before = torch.get_num_threads()
    try:
        torch.set_num_threads(2)
        found = hardware()
    finally:
        torch.set_num_threads(before)
    assert found["threads_by_library"]["torch"] == 2
    assert found["threads"] >= 2
    assert found["device"] == "cpu" or torch.cuda.is_initialized()
