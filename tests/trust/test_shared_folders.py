"""A folder that a stranger has prepared, and one that two commands fill at once: every command that writes."""

import os
import shutil
import sys
from pathlib import Path

import pytest

if not sys.platform.startswith("linux"):
    pytest.skip("commands run in forked processes", allow_module_level=True)

from mmweaver.compression.mmw_container import MmwFile
from mmweaver.core.checksums import SUMS_FILE, damages
from mmweaver.core.staging import COMMITTED, STAGED, staging_path
from tests.faults.fault_injection import tree
from tests.faults.faulted_commands import FaultedCommand, faulted_commands, prepare_inputs
from tests.faults.faulted_runs import computed_once, stopped_clocks
from tests.trust.commands_in_children import Ended, run_at_once

COMMANDS = [one.name for one in faulted_commands(Path())]
QUICK = {"compress --append", "decompress", "export", "motion", "points", "rooms"}  # all others in `make test-slow`
NAMES = [pytest.param(name, marks=[pytest.mark.slow] * (name not in QUICK)) for name in COMMANDS]
VARYING = ("log.jsonl", "sequences.json")  # its lines say how long they took; it names --out
OTHERS = "precious"


class Command:
    """A command whose long computations are done once, what it finds, and what it makes."""

    def __init__(self, command: FaultedCommand, work: Path):
        self.command, self.old, self.first = command, work / "old", work / "first"
        computed: dict = {}

        def run(out: Path, line: str | None = None) -> int:
            with computed_once(command.computes, computed), stopped_clocks():
                return command.run(out, line)

        self.run = run
        self.old.mkdir(parents=True)
        if command.before is not None:
            assert run(self.old, command.before) == 0
        shutil.copytree(self.old, self.first)
        assert run(self.first) == 0
        self.expected = tree(self.first, VARYING)

    def fresh(self, out: Path) -> Path:
        """A folder as the command finds it."""
        shutil.copytree(self.old, out)
        return out


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    prepare_inputs(folder, which=("walk", "walk.mmw"))
    return folder


@pytest.fixture(scope="module")
def commands(inputs: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Command]:
    class Made(dict):
        def __missing__(self, name: str) -> Command:
            if name == "train":
                prepare_inputs(inputs, which=("data",))
            found = next(one for one in faulted_commands(inputs) if one.name == name)
            self[name] = Command(found, tmp_path_factory.mktemp("command"))
            return self[name]

    return Made()


def without_leftovers(folder: Path) -> bool:
    return not [path for path in folder.rglob("*") if STAGED.fullmatch(path.name) or path.name == COMMITTED]


# two writers --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", NAMES)
def test_two_at_once_make_what_one_makes_or_one_is_refused(name: str, commands: dict[str, Command], tmp_path: Path):
    command = commands[name]
    out = command.fresh(tmp_path / "out")
    ended = run_at_once([lambda: command.run(out)] * 2)
    done = [one for one in ended if one.status == 0]
    assert all(one.is_sound for one in ended), ended
    assert done, ended
    if command.command.appends:
        held, total = MmwFile(command.old / "a.mmw").num_frames, MmwFile(out / "a.mmw").num_frames
        assert total == held * (1 + len(done)), "what a command has added is gone"
        return
    assert tree(out, VARYING) == command.expected
    assert without_leftovers(out)
    for sums in out.rglob(SUMS_FILE):
        assert damages(sums.parent) == []


# a stranger's folder ------------------------------------------------------------------------------------------------
def victim(folder: Path) -> Path:
    """A folder of somebody else, as a plain one and as one that looks like a result."""
    (folder / "sub").mkdir(parents=True)
    for name in ("thesis.txt", "radar.npz", "SHA256SUMS", "sub/notes.txt"):
        (folder / name).write_text(OTHERS)
    return folder


def plant(kind: str, place: Path, target: Path) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    if place.is_dir():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    if kind == "link":
        place.symlink_to(target)
    elif kind == "fifo":
        os.mkfifo(place)
    elif kind == "file":
        place.write_text(OTHERS)
    else:
        victim(place)


def is_refused_or_done(ended: Ended, others: Path, before: dict[str, str]) -> None:
    assert ended.is_sound, ended
    assert tree(others) == before, f"something outside --out was changed: {ended}"


@pytest.mark.parametrize("kind", ["link", "fifo", "file", "folder"])
@pytest.mark.parametrize("name", NAMES)
def test_what_is_planted_under_markers_moves_nothing(
    name: str, kind: str, commands: dict[str, Command], tmp_path: Path
):
    """The marker of an interrupted move, and the name of an unfinished file of a dead process."""
    command = commands[name]
    others = victim(tmp_path / "others")
    before, folders = tree(others), [Path()]
    folders += [Path(path) for path, content in command.expected.items() if content == "folder"][:2]
    staged = staging_path(Path("walk.npz")).name.replace(f"-{os.getpid()}-", "-999999999-")
    for marker in (COMMITTED, staged):
        out = command.fresh(tmp_path / marker)
        for folder in folders:
            plant(kind, out / folder / marker, others)
        (ended,) = run_at_once([lambda out=out: command.run(out)])
        is_refused_or_done(ended, others, before)


@pytest.mark.parametrize("kind", ["link", "fifo"])
@pytest.mark.parametrize("name", NAMES)
def test_links_at_the_names_of_results_are_not_followed(
    name: str, kind: str, commands: dict[str, Command], tmp_path: Path
):
    """One at a time: every file and folder that the command makes is a link into a folder of somebody else."""
    command = commands[name]
    given = {word.removeprefix("OUT/") for word in command.command.line.split() if word.startswith("OUT/")}
    names = [path for path in command.expected if path not in given]  # a link that is named itself is followed
    kinds: dict[str, list[str]] = {}
    for path in names:
        kinds.setdefault(f"{len(Path(path).parts)} {Path(path).suffix} {Path(path).stem[:3]}", []).append(path)
    for number, paths in enumerate(kinds.values()):
        path = paths[0]
        others = victim(tmp_path / f"others {number}")
        target = others / ("sub" if command.expected[path] == "folder" else "thesis.txt")
        out = command.fresh(tmp_path / f"out {number}")
        plant(kind, out / path, target)
        before = tree(others)
        (ended,) = run_at_once([lambda out=out: command.run(out)])
        assert ended.is_sound, (path, ended)
        assert tree(others) == before, f"{path}: something outside --out was changed: {ended}"
