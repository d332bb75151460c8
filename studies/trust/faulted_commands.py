"""The commands that write, as fault injection runs them: small, and with the same bits each time."""

import importlib
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mmweaver.cli.main import main
from studies.trust.fault_injection import HIDDEN_COMMITTED, Fault, Outcome, run_in_child, tree

# files with times of day, seconds or paths in them, and checksums of those
VARYING = ("meta.json", "SHA256SUMS", "log.jsonl", "README.md", "checkpoint.pt")
DEMO = ["generate", "--demo", "--quiet", "--frames", "2", "--no-pictures", "--method", "physics"]
DATASET = ["--rooms", "office", "--layouts", "2", "--sequences", "1", "--frames", "2", "--quiet"]
TRAIN = ["train", "weaver", "--steps", "2", "--batch", "1", "--save-every", "0", "--validate-every", "1", "--quiet"]


@dataclass(frozen=True, kw_only=True)
class FaultedCommand:
    """A command line by its output folder; `before` makes what it overwrites; a resumable one keeps finished work."""

    name: str
    argv: Callable[[Path], list[str]]
    before: Callable[[Path], list[str]] | None = None
    is_resumable: bool = False
    varying: tuple[str, ...] = VARYING


# imported before anything is forked, or every child would
HEAVY = (
    "matplotlib.pyplot", "matplotlib.backends.backend_agg", "PIL.PngImagePlugin", "zarr", "zarr.codecs", "tomli_w",
    "safetensors.torch", "torch", "scipy.spatial", "scipy.ndimage", "mmweaver.verification", "mmweaver.generate",
    "mmweaver.figures.motion_strip", "mmweaver.motion.empty_floor", "mmweaver.recordings.processing",
    "mmweaver.scene.procedural.room_files", "mmweaver.compression.mmw_codec", "mmweaver.datasets.generate_rooms",
    "mmweaver.datasets.room_generation", "mmweaver.training.network_training", "mmweaver.training.validation_sheet",
    "mmweaver.cli.batch", "mmweaver.cli.summary", "mmweaver.paths.ray_traced",
)  # fmt: skip


def prepare_inputs(inputs: Path, *, which: tuple[str, ...] = ("walk", "walk.mmw", "data")) -> None:
    """Makes what the commands read: sentences, a recording, its .mmw file, and a data set without signals."""
    for name in HEAVY:
        importlib.import_module(name)
    inputs.mkdir(parents=True, exist_ok=True)
    (inputs / "sentences.txt").write_text("a person waves\na person walks to the left\n", encoding="utf-8")
    (inputs / "walk.toml").write_text('text = "a person waves"\n', encoding="utf-8")
    made = {
        "walk": [*DEMO, "--text", "a person waves", "--bin", "--out", str(inputs / "walk")],
        "walk.mmw": ["compress", str(inputs / "walk"), "-o", str(inputs / "walk.mmw"), "--bytes", "3000", "--quiet"],
        "data": ["dataset", str(inputs / "data"), "--rooms", "office,dining_room", "--layouts", "1", "--sequences",
                 "1", "--frames", "2", "--geometry-only", "--quiet"],
    }  # fmt: skip
    for name in which:
        if not (inputs / name).exists():
            outcome = run_in_child(lambda name=name: main(made[name]), inputs)
            assert outcome.status == 0, outcome


def faulted_commands(inputs: Path) -> list[FaultedCommand]:
    """Every command that writes; `inputs` as `prepare_inputs` makes them."""
    walk, mmw = str(inputs / "walk"), str(inputs / "walk.mmw")
    bins = [f"{walk}/adc_data.bin", "--radar", f"{walk}/radar.json", "--no-pictures", "--quiet"]
    wave = [*DEMO, "--text", "a person waves"]

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
        FaultedCommand(name="rooms", argv=lambda out: [
            "rooms", str(out / "r"), "--kinds", "office", "--layouts", "1", "--quiet"], varying=()),
        FaultedCommand(name="generate", argv=lambda out: [*wave, "--out", str(out / "g")]),
        FaultedCommand(name="generate --overwrite", argv=again,
                       before=lambda out: [*wave, "--seed", "2", "--out", str(out / "g")]),
        FaultedCommand(name="generate --texts", is_resumable=True, argv=lambda out: [
            *DEMO, "--texts", str(inputs / "sentences.txt"), "--out", str(out / "s")]),
        FaultedCommand(name="dataset", is_resumable=True, varying=(), argv=lambda out: [
            "dataset", str(out / "data"), *DATASET]),
        FaultedCommand(name="train", is_resumable=True, argv=lambda out: [
            *TRAIN, "--data", str(inputs / "data"), "--out", str(out / "run"), "--device", "cpu"]),
    ]  # fmt: skip


class FaultedRuns:
    """Runs one command with faults, and says what was not survived."""

    def __init__(self, command: FaultedCommand, work: Path):
        """Runs it without a fault first: the files of that run are what every other must end with."""
        self.command, self.work = command, work
        self.old = work / "old"
        _emptied(self.old)
        if command.before is not None:
            self._run(command.before, self.old)
        self.before = tree(self.old)
        outcome = self._run(command.argv, self._fresh())
        assert outcome.status == 0, f"{command.name}: {outcome}"
        self.events = outcome.events
        self.expected = tree(work / "out", command.varying)

    def _fresh(self) -> Path:
        out = self.work / "out"
        _emptied(out)
        shutil.copytree(self.old, out, dirs_exist_ok=True)
        return out

    def _run(self, argv: Callable[[Path], list[str]], out: Path, fault: Fault | None = None) -> Outcome:
        return run_in_child(lambda: main(argv(out)), out, fault)

    def problems(self, fault: Fault) -> list[str]:
        """What is wrong after a fault and, once more, after the command is run again; nothing where all is survived."""
        out = self._fresh()
        outcome = self._run(self.command.argv, out, fault)
        found = [] if fault.kind == "kill" else self._after_failure(outcome, out)
        if fault.kind == "kill" and outcome.status is not None:
            found.append(f"was not killed but ended with {outcome.status}")
        second = self._run(self.command.argv, out)
        now = tree(out, self.command.varying)
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
        if not self.command.is_resumable and not is_whole and now != self.before:
            changed = sorted(name for name in {*now, *self.before} if now.get(name) != self.before.get(name))
            found.append(f"half-written: {changed[:4]}")
        return found


def _emptied(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
