"""Commands that die, or find the disk full, at an event of the file system: run again, they end with the same bits.

Here a sample of events of the quick commands; all events of all commands are the nightly test below (`make faults`).
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

if not sys.platform.startswith("linux"):
    pytest.skip("faults are injected into forked processes", allow_module_level=True)

from tests.faults.fault_injection import Fault, may_mount
from tests.faults.faulted_commands import faulted_commands, prepare_inputs
from tests.faults.faulted_runs import FaultedRuns

QUICK = ("process",)
LIMITS = (0, 100, 3_000, 20_000, 200_000)  # bytes of a file
PARTS = (0.0, 0.3, 0.6, 0.9)  # of the result, that a small file system has room for
ALL = tuple(command.name for command in faulted_commands(Path()))


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    prepare_inputs(folder, which=("walk",))
    return folder


def faulted(name: str, inputs: Path, work: Path) -> FaultedRuns:
    return FaultedRuns(next(one for one in faulted_commands(inputs) if one.name == name), work)


def faults_of(runs: FaultedRuns) -> Iterator[Fault]:
    """All faults of a command: at each of its events, of files that may not grow, of small file systems."""
    for kind in ("kill", "full", "once"):
        yield from (Fault(kind=kind, number=number) for number in range(1, runs.events + 1))
    yield from (Fault(kind="large", number=limit) for limit in LIMITS)
    if may_mount():
        yield from (Fault(kind="disk", number=1 + int(part * runs.pages)) for part in PARTS)


@pytest.mark.parametrize("name", QUICK)
def test_a_sample_of_events(name: str, inputs: Path, tmp_path: Path):
    runs = faulted(name, inputs, tmp_path)
    middle, late = runs.events // 2, runs.events - 2
    faults = [Fault(kind="kill", number=late), Fault(kind="once", number=middle), Fault(kind="large", number=1000)]
    faults += [Fault(kind="interrupt", number=number) for number in (4, middle, late)]
    assert {fault: runs.problems(fault) for fault in faults} == {fault: [] for fault in faults}
    if may_mount():
        assert runs.problems(Fault(kind="disk", number=runs.pages // 2)) == []


# a quick command of it: test_a_sample_of_events
@pytest.mark.slow
@pytest.mark.skipif(not may_mount(), reason="only root may mount a small file system")
@pytest.mark.parametrize("name", ["generate", "decompress", "dataset", "train"])
def test_a_full_disk(name: str, inputs: Path, tmp_path: Path):
    prepare_inputs(inputs)
    runs = faulted(name, inputs, tmp_path)
    faults = [fault for fault in faults_of(runs) if fault.kind == "disk"]
    assert faults
    assert {fault: runs.problems(fault) for fault in faults} == {fault: [] for fault in faults}


@pytest.mark.slow  # a sample of it: test_a_sample_of_events
@pytest.mark.parametrize("name", ALL)
def test_every_event(name: str, inputs: Path, tmp_path: Path):
    prepare_inputs(inputs)
    runs = faulted(name, inputs, tmp_path)
    assert {fault: found for fault in faults_of(runs) if (found := runs.problems(fault))} == {}


@pytest.mark.slow  # a sample of it: test_a_sample_of_events
@pytest.mark.parametrize("name", [name for name in ALL if not name.startswith(("dataset", "train"))])
def test_an_interruption_at_every_event(name: str, inputs: Path, tmp_path: Path):
    prepare_inputs(inputs)
    runs = faulted(name, inputs, tmp_path)
    faults = [Fault(kind="interrupt", number=number + 1) for number in range(runs.events)]
    assert {fault: found for fault in faults if (found := runs.problems(fault))} == {}
