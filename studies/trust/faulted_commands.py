"""The commands that write, as fault injection runs them: small, and with the same bits each time."""

import contextlib
import functools
import hashlib
import importlib
import io
import mmap
import pickle
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any
from unittest import mock

import mmweaver
from mmweaver.cli.main import main
from studies.trust.fault_injection import (
    HIDDEN_COMMITTED,
    Fault,
    Outcome,
    run_in_child,
    small_disk,
    tree,
    what_a_run_finds,
)

# files with times of day, seconds or paths in them, and checksums of those
VARYING = ("log.jsonl",)
DEMO = ["generate", "--demo", "--quiet", "--frames", "2", "--no-pictures", "--method", "physics"]
DATASET = ["--rooms", "office", "--layouts", "2", "--sequences", "1", "--frames", "2", "--quiet"]
TRAIN = ["train", "weaver", "--steps", "2", "--batch", "1", "--save-every", "0", "--validate-every", "1", "--quiet"]
LABELLED = ["--each", "1", "--seconds", "0.2", "--subjects", "1", "--method", "physics", "--quiet"]
GENERATED = ("mmweaver.generate:reconstruct", "mmweaver.generate:compose_request")


@dataclass(frozen=True, kw_only=True)
class FaultedCommand:
    """A command line by its output folder; `before` makes what it overwrites; a resumable one keeps finished work.

    One that `grows` is not run twice: whole parts are kept, and the same folder is refused.
    `computes`: "module:function" of long computations that write nothing; each is done once, and every run takes its
    result, which follows from the arguments.
    """

    name: str
    argv: Callable[[Path], list[str]]
    before: Callable[[Path], list[str]] | None = None
    is_resumable: bool = False
    grows: bool = False
    varying: tuple[str, ...] = VARYING
    computes: tuple[str, ...] = ()


def prepare_inputs(inputs: Path, *, which: tuple[str, ...] = ("walk", "walk.mmw", "data")) -> None:
    """Makes what the commands read: sentences, a recording, its .mmw file, and a data set without signals."""
    inputs.mkdir(parents=True, exist_ok=True)
    (inputs / "sentences.txt").write_text("a person waves\na person walks to the left\n", encoding="utf-8")
    activities = '[activities]\nwaving = ["a person waves"]\nsitting = ["a person squats"]\n'
    (inputs / "activities.toml").write_text(activities, encoding="utf-8")
    made = {
        "walk": [*DEMO, "--text", "a person waves", "--bin", "--out", str(inputs / "walk")],
        "walk.mmw": ["compress", str(inputs / "walk"), "-o", str(inputs / "walk.mmw"), "--bytes", "3000", "--quiet"],
        "data": ["dataset", str(inputs / "data"), "--rooms", "office,dining_room", "--layouts", "1", "--sequences",
                 "1", "--frames", "2", "--geometry-only", "--quiet"],
    }  # fmt: skip
    for name in which:
        if not (inputs / name).exists():
            assert main(made[name]) == 0, made[name]


def faulted_commands(inputs: Path) -> list[FaultedCommand]:
    """Every command that writes; `inputs` as `prepare_inputs` makes them."""
    walk, mmw = str(inputs / "walk"), str(inputs / "walk.mmw")
    bins = [f"{walk}/adc_data.bin", "--radar", f"{walk}/radar.json", "--no-pictures", "--quiet"]
    wave = [*DEMO, "--text", "a person waves"]
    room = Path(mmweaver.__file__).parent / "sample"
    files = {"--rgb": "rgb.webp", "--depth": "depth.png", "--camera": "camera.json"}
    sample = [word for option, name in files.items() for word in (option, str(room / name))]

    def again(one: Path) -> list[str]:
        return [*wave, "--seed", "1", "--out", str(one / "g"), "--overwrite"]

    return [
        FaultedCommand(name="motion", argv=lambda out: [
            "motion", "a person waves", "--out", str(out / "m.npz"), "--picture", str(out / "m.png")]),
        FaultedCommand(name="decompress", argv=lambda out: [
            "decompress", mmw, "-o", str(out / "d/radar.npz"), "--quiet"]),
        FaultedCommand(
            name="decompress --overwrite",
            argv=lambda out: ["decompress", mmw, "-o", str(out / "radar.npz"), "--quiet", "--overwrite"],
            before=lambda out: ["decompress", mmw, "-o", str(out / "radar.npz"), "--quiet", "--frames", "0:1"],
        ),
        FaultedCommand(name="compress", argv=lambda out: [
            "compress", walk, "-o", str(out / "a.mmw"), "--bytes", "3000", "--quiet"]),
        FaultedCommand(name="process", argv=lambda out: ["process", *bins, "--out", str(out / "p")]),
        FaultedCommand(name="compress --lossless", argv=lambda out: [
            "compress", *bins[:3], "-o", str(out / "a.mmwl"), "--lossless", "--quiet"]),
        FaultedCommand(name="points", argv=lambda out: [
            "points", f"{walk}/points.npz", "-o", str(out / "points.npz"), "--quiet"]),
        FaultedCommand(name="export", argv=lambda out: ["export", walk, "--to", "mars", "--out", str(out / "e")]),
        FaultedCommand(name="rooms", argv=lambda out: [
            "rooms", str(out / "r"), "--kinds", "office", "--layouts", "1", "--quiet"], varying=(), computes=(
            "mmweaver.scene.procedural.procedural_room:make_room",
            "mmweaver.scene.procedural.procedural_room:ProceduralRoom.photo")),
        FaultedCommand(name="generate", argv=lambda out: [*wave, "--out", str(out / "g")], computes=GENERATED),
        FaultedCommand(name="generate --overwrite", argv=again, computes=GENERATED,
                       before=lambda out: [*wave, "--seed", "2", "--out", str(out / "g")]),
        FaultedCommand(name="generate --texts", is_resumable=True, computes=GENERATED, argv=lambda out: [
            *DEMO, "--texts", str(inputs / "sentences.txt"), "--out", str(out / "s")]),
        FaultedCommand(name="generate --stream", grows=True, computes=GENERATED, argv=lambda out: [
            *DEMO[:3], "--stream", "--method", "physics", "--frames", "21", "--bin", "--texts",
            str(inputs / "sentences.txt"), "--out", str(out / "stream")]),
        FaultedCommand(name="dataset", is_resumable=True, varying=(), argv=lambda out: [
            "dataset", str(out / "data"), *DATASET], computes=("mmweaver.datasets.room_generation:generate_room",)),
        FaultedCommand(name="dataset --activities", is_resumable=True, argv=lambda out: [
            "dataset", str(out / "set"), "--activities", str(inputs / "activities.toml"), *sample, *LABELLED],
            computes=(*GENERATED, "mmweaver.activity_sets.build_set:compose_request")),
        FaultedCommand(name="train", is_resumable=True, argv=lambda out: [
            *TRAIN, "--data", str(inputs / "data"), "--out", str(out / "run"), "--device", "cpu"],
            computes=("mmweaver.training.network_examples:reconstruct", "mmweaver.training.network_training:draw_sheet",
                      "mmweaver.training.network_examples:power_maps")),
    ]  # fmt: skip


class FaultedRuns:
    """Runs one command with faults, and says what was not survived."""

    def __init__(self, command: FaultedCommand, work: Path):
        """Runs it without a fault first: the files of that run are what every other must end with."""
        self.command, self.work = command, work
        self.computed: dict[bytes, Any] = {}
        self.second_runs: dict[frozenset[tuple[str, str]], list[str]] = {}  # by what they began with
        _emptied(work / "first")
        with contextlib.redirect_stdout(io.StringIO()):
            status = self._main(command.argv, work / "first")  # in this process: children need not import anything
        if status != 0:
            raise RuntimeError(f"{command.name} fails without a fault")
        self.old = work / "old"
        _emptied(self.old)
        if command.before is not None:
            self._run(command.before, self.old)
        self.before = tree(self.old)
        outcome = self._run(command.argv, self._fresh())
        assert outcome.status == 0, f"{command.name}: {outcome}"
        self.events = outcome.events
        self.expected = tree(work / "out", command.varying)
        self.pages = _pages(work / "out")

    def _fresh(self) -> Path:
        out = self.work / "out"
        _emptied(out)
        shutil.copytree(self.old, out, dirs_exist_ok=True)
        return out

    def _run(self, argv: Callable[[Path], list[str]], out: Path, fault: Fault | None = None) -> Outcome:
        return run_in_child(lambda: self._main(argv, out), out, fault)

    def _main(self, argv: Callable[[Path], list[str]], out: Path) -> int:
        with computed_once(self.command.computes, self.computed), stopped_clocks():
            return main(argv(out))

    def problems(self, fault: Fault) -> list[str]:
        """What is wrong after a fault and, once more, after the command is run again; nothing where all is survived."""
        if fault.kind == "disk":
            return self._problems_of_small_disk(fault.number)
        out = self._fresh()
        outcome = self._run(self.command.argv, out, fault)
        found = [] if fault.kind == "kill" else self._after_failure(outcome, out)
        if fault.kind == "kill" and outcome.status is not None:
            found.append(f"was not killed but ended with {outcome.status}")
        state = what_a_run_finds(out)
        if state not in self.second_runs:  # from the same files the same command does the same
            self.second_runs[state] = self._of_second_run(out)
        return found + self.second_runs[state]

    def _problems_of_small_disk(self, pages: int) -> list[str]:
        """What is wrong where the result lies on a disk that it does not fit on, and after space is made there."""
        out = self.work / "out"
        _emptied(out)
        with small_disk(out, _pages(self.old) + pages) as make_space:
            shutil.copytree(self.old, out, dirs_exist_ok=True)
            found = self._after_failure(self._run(self.command.argv, out), out)
            make_space()
            return found + self._of_second_run(out)

    def _of_second_run(self, out: Path) -> list[str]:
        second, found = self._run(self.command.argv, out), []
        now = tree(out, self.command.varying)
        if self.command.grows and second.status == 2 and "is not empty" in second.stderr:
            return _of_parts(now, self.expected)
        is_there = second.status == 2 and "exists" in second.stderr and now == self.expected
        if second.status != 0 and not is_there:
            found.append(f"run again: {second.status} {second.stderr[-200:]}")
        if now != self.expected:
            different = sorted(name for name in {*now, *self.expected} if now.get(name) != self.expected.get(name))
            found.append(f"run again: other files: {different[:4]}")
        return found

    def _after_failure(self, outcome: Outcome, out: Path) -> list[str]:
        now = tree(out)
        if outcome.status == 0:  # an event that may fail, or a file that never grew so large
            return [] if tree(out, self.command.varying) == self.expected else ["status 0 without the result"]
        found = []
        lines = [line for line in outcome.stderr.splitlines() if line.strip()]
        if outcome.status != 2:
            found.append(f"status {outcome.status}")
        elif len(lines) != 1 or len(lines[0]) > 500 or not lines[0].startswith("mmweaver: error: "):
            found.append(f"not one line: {outcome.stderr[:200]!r}")
        if any(HIDDEN_COMMITTED in name for name in now):
            return found  # complete new files are there, and the next run moves them into place
        litter = [name for name in now if Path(name).name.startswith(".")]
        if litter:
            found.append(f"left over: {litter[:3]}")
        is_whole = tree(out, self.command.varying) == self.expected  # a name that could not be synced is reported
        if not (self.command.is_resumable or self.command.grows) and not is_whole and now != self.before:
            changed = sorted(name for name in {*now, *self.before} if now.get(name) != self.before.get(name))
            found.append(f"half-written: {changed[:4]}")
        return found


def _pages(folder: Path) -> int:
    """Pages that a tmpfs gives to a folder: each file has its own, and the root one."""
    return 1 + sum(-(-path.stat().st_size // mmap.PAGESIZE) for path in folder.rglob("*") if path.is_file())


def _of_parts(now: dict[str, str], expected: dict[str, str]) -> list[str]:
    """What is wrong with the parts that are there, and what is left over."""
    wrong = [name for name, digest in now.items() if "/parts/" in name and expected.get(name) != digest]
    hidden = [name for name in now if Path(name).name.startswith(".")]
    return [f"not whole, or left over: {names[:4]}" for names in (sorted({*wrong, *hidden}),) if names]


@contextlib.contextmanager
def stopped_clocks() -> Iterator[None]:
    """No time passes that commands write into their files."""
    with mock.patch("time.process_time", float), mock.patch("mmweaver.core.stages.perf_counter", float):
        yield


@contextlib.contextmanager
def computed_once(names: tuple[str, ...], results: dict[bytes, Any]) -> Iterator[None]:
    """Functions, given as "module:function", take their results from `results` by their arguments, or add them."""
    with contextlib.ExitStack() as patches:
        for name in names:
            module, path = name.split(":")
            *owners, function = path.split(".")
            owner = functools.reduce(getattr, owners, importlib.import_module(module))
            patches.enter_context(_taken_from(results, owner, function))
        yield


def _taken_from(results: dict[bytes, Any], owner: Any, name: str) -> Any:
    function = getattr(owner, name)

    def remembered(*arguments: Any, **options: Any) -> Any:
        key = _key_of((name, arguments, options))
        if key not in results:
            results[key] = function(*arguments, **options)
        return results[key]

    return mock.patch.object(owner, name, remembered)


class _Keys(pickle.Pickler):
    """Equal arguments become equal bytes: records by their fields, without what they cache, and tensors by values."""

    def reducer_override(self, value: Any) -> Any:
        if is_dataclass(value) and not isinstance(value, type):
            return tuple, ([getattr(value, field.name) for field in fields(value)],)
        if type(value).__name__ == "Tensor":
            return str, (f"{value.dtype} {value.shape}", value.detach().numpy().tobytes())
        return NotImplemented


def _key_of(arguments: Any) -> bytes:
    pickled = io.BytesIO()
    pickler = _Keys(pickled)
    pickler.fast = True  # else objects that occur twice would differ from equal ones
    pickler.dump(arguments)
    return hashlib.sha256(pickled.getvalue()).digest()


def _emptied(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
