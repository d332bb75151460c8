"""A FIFO or a device given for any file of any command is refused at once, in one line that names it."""

import os
import signal
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.cli.main import COMMANDS, main, parser_of
from mmweaver.core.options import Source, option_kind, option_name, options_of
from mmweaver.models.pose_network import PoseNetwork
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.recognition.recogniser import save_recogniser
from tests.fuzz.set_readers import GOLDEN
from tests.recognition.small_recogniser import small_recogniser

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no FIFO here")
SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"
ROOM = {name: str(SAMPLE / file) for name, file in
        (("--rgb", "rgb.webp"), ("--depth", "depth.png"), ("--camera", "camera.json"))}  # fmt: skip
WEIGHTS = str(SAMPLE.parent / "weights" / "weaver.safetensors")
WRITTEN = {"--out", "-o", "out", "--pictures"}
# What a command needs besides the option that is tried.
NEEDED: dict[str, dict[str, str | None]] = {
    "generate": {**ROOM, "--text": "a person waves", "--out": "OUT"},
    "export": {"--to": "mat", "--out": "OUT"}, "process": {"file": "BIN", "--radar": "awr1843", "--out": "OUT"},
    "compare": {"a": "CAPTURE", "b": "CAPTURE"}, "plot": {"signal": "CAPTURE", "-o": "OUT"},
    "points": {"-o": "OUT"}, "radar": {"radar": "awr1843"}, "decompress": {"-o": "OUT"}, "rooms": {"out": "OUT"},
    "compress": {"file": "BIN", "--radar": "awr1843", "-o": "OUT", "--bytes": "9999"},
    "calibrate": {"recordings": "BIN", "--radar": "awr1843", "--out": "OUT"},
    "recognise": {"action": "train", "place": "A", "--out": "OUT"},
    "studio": {"--port": "0"},  # whatever else listens on the usual one
    "evaluate": {"task": "zero-shot-activity"}, "motion": {"text": "a person waves"},
    "dataset": {"out": "OUT", "--rooms": "office"}, "pose": {"model": "POSE", "--points": "BIN", "--out": "OUT"},
    "fit": {"signal": "BIN", "--radar": "awr1843", "-o": "field.safetensors"},
    "train": {"recipe": "weaver", "task": None, "--data": "DATA", "--out": "OUT"},
}  # fmt: skip
# Other options that an option needs (a word) or does not go with (None).
WITH: dict[tuple[str, str], dict[str, str | None]] = {
    ("generate", "--texts"): {"--text": None},
    ("generate", "--motion"): {"--text": None}, ("generate", "--room"): dict.fromkeys(ROOM),
    ("dataset", "--activities"): {"--rooms": None, "--room": str(SAMPLE)},
    ("dataset", "--from-results"): {"--rooms": None},
    ("dataset", "--room"): {"--rooms": None, "--activities": "A"},
    ("generate", "--motion-model"): {"--motion-set": "for=all"},
    ("dataset", "--board"): {"--rooms": None, "--activities": "A", "--room": str(SAMPLE)},
    ("recognise", "--recordings"): {"action": "score", "--out": None, "place": "MODEL"},
    ("recognise", "--points"): {"action": "run", "--out": None, "place": "MODEL"},
    ("evaluate", "--weights"): {"--recordings": "."},
    ("plot", "--radar"): {"signal": "BIN"},
    ("compare", "--radar"): {"a": "BIN"},
    ("train", "task"): {"recipe": "pose", "--data": None},
    ("train", "--recordings"): {"--data": None, "--weights": WEIGHTS},
    ("train", "--weights"): {"--data": None, "--recordings": "CAPTURE"},
    **{("train", name): {"--data": None, "--recordings": "CAPTURE", "--weights": WEIGHTS, **ROOM} for name in ROOM},
}  # fmt: skip


def _options() -> list[tuple[str, str]]:
    """Every option and argument of every command that names something to read."""
    found = []
    for command, (_, kind) in parser_of(*COMMANDS)[1].items():
        for one in options_of(kind):
            name = one.name if one.metadata.get("positional") else f"--{option_name(one)}"
            if option_kind(one)[0] in (Path, Source) and name not in WRITTEN:
                found.append((command, name))
    return found


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("files")
    (folder / "a.bin").write_bytes(bytes(4096))
    (folder / "a.toml").write_text('radar = "iwr1443_mars"\n[activities]\na = "a person waves"\nb = "a person walks"\n')
    np.savez(folder / "m.npz", poses=np.zeros((4, 66)), trans=np.zeros((4, 3)), mocap_framerate=60.0)
    save_recogniser(folder / "model", small_recogniser(folder / "a.toml"))
    card = WeightsCard(
        recipe="pose", licence="MIT", dataset_sha256="", radar="awr1843", steps=0, seed=0, validation_loss=0.0,
        mmweaver_version="0", settings={"window_s": 1.0, "frame_rate_hz": 10.0},
    )  # fmt: skip
    save_weights(folder / "pose.safetensors", PoseNetwork(), card)
    with zipfile.ZipFile(GOLDEN) as archive:
        archive.extractall(folder)
    os.mkfifo(folder / "fifo")
    return {"BIN": str(folder / "a.bin"), "A": str(folder / "a.toml"), "MOTION": str(folder / "m.npz"),
            "CAPTURE": str(folder / "results"), "DATA": str(folder),
            "MODEL": str(folder / "model"), "POSE": str(folder / "pose.safetensors"),
            "FIFO": str(folder / "fifo")}  # fmt: skip


@pytest.mark.parametrize("special", ["FIFO", pytest.param("/dev/zero", marks=pytest.mark.slow)])
@pytest.mark.parametrize(("command", "name"), _options())
def test_it_is_refused_at_once(
    command: str, name: str, special: str, files: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    place = files.get(special, special)
    words = {**NEEDED.get(command, {}), **WITH.get((command, name), {}), name: place}
    known = {**files, "OUT": str(tmp_path / "out")}
    argv = [command]
    for option, word in words.items():
        if word is not None:
            argv += [option] * option.startswith("-") + [known.get(word, word)]
    assert _status(argv) == 2
    error = capsys.readouterr().err
    assert Path(place).name in error, error
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def _status(argv: list[str]) -> Any:
    """Of a command that may take 20 seconds of a loaded machine."""

    def late(*_: Any) -> None:
        raise TimeoutError(f"mmweaver {argv[0]} waits")

    previous = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, 20)
    try:
        return main(argv)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)
