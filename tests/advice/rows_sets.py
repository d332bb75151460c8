"""Advice about data sets, training, recognisers and what else takes long: up to where the work would begin."""

import json
import shutil
from pathlib import Path

import torch
from PIL import Image

from mmweaver.cli.main import main
from mmweaver.core.tensor_files import write_tensors
from mmweaver.io.dca1000 import write_bin
from tests.advice.harness import Row, add, drop, edit, instead, plus
from tests.advice.made_inputs import SAMPLE
from tests.recordings.test_plausibility import RADAR, room

SET = "dataset out --activities {activities} --dry-run"
TRAIN = "train weaver --data {walk} --out out"
ROOMS = "dataset out --layouts 1 --sequences 1 --dry-run"


def _capture() -> None:
    write_bin(Path("adc.bin"), room(RADAR, 2), counts_per_unit=1.0)
    Path("radar.json").write_text(RADAR.to_json())
    words = ["process", "adc.bin", "--radar", "radar.json", "--no-pictures", "--no-analysis", "--quiet"]
    assert main([*words, "--out", "capture"]) == 0


def _capture_of_another_photo() -> None:
    _capture()
    Path("capture/SHA256SUMS").unlink()
    photo = {"path": str(SAMPLE / "rgb.webp"), "sha256": 64 * "0"}
    Path("capture/meta.json").write_text(json.dumps({"inputs": {"rgb": photo}}))


def _photo(folder: str) -> None:
    for name in ("depth.png", "camera.json"):
        shutil.copy(SAMPLE / name, Path(folder) / name)
    with Image.open(SAMPLE / "rgb.webp") as picture:
        picture.save(Path(folder) / "rgb.png")


ROWS = (
    Row(
        "is for labelled sets; give --activities, too",
        f"{ROOMS} --per-class 2",
        (instead("give --activities", "--layouts 1 --sequences 1", "--activities {activities} --room {own_room}"),),
    ),
    Row(
        "is for data sets of rooms; leave it out",
        f"{SET} --room {{own_room}} --layouts 3",
        (instead("leave it out", "--layouts 3"),),
    ),
    Row(
        "--from-results takes sequences as they are",
        "dataset out --from-results {results} --per-class 2",
        (drop("--per-class"),),
    ),
    Row("which room? give --room DIR", SET, (add("--room", "{own_room}"),)),
    Row(
        "give what mmweaver generate --texts wrote",
        "dataset out --from-results {nothing}",
        (instead("give what mmweaver generate --texts wrote", "{nothing}", "{results}"),),
    ),
    Row(
        "is a sentence of no activity",
        "dataset out --from-results {results} --activities {jumping}",
        (drop("--activities"), instead("add it to one", "{jumping}", "{activities}")),
    ),
    # training: the options and what is read alone
    Row(
        "□ has no photo of its room",
        "train weaver --recordings capture --weights {weights} --out out",
        (
            edit("put rgb.png, depth.png (or depth.npy) and camera.json into it", lambda: _photo("capture")),
            edit("or into the folder above", lambda: _photo(".")),
            plus("give --rgb and --depth", "--rgb", "{rgb}", "--depth", "{depth}", "--camera", "{camera}"),
        ),
        before=_capture,
    ),
    Row(
        "has changed since □ was written",
        "train weaver --recordings capture --weights {weights} --out out",
        (plus("give --rgb and --depth", "--rgb", "{rgb}", "--depth", "{depth}", "--camera", "{camera}"),),
        before=_capture_of_another_photo,
    ),
    Row(
        "is not a weight file of mmweaver; give one that",
        "train weaver --recordings {walk} --weights foreign.safetensors --out out",
        (instead("give one that mmweaver train wrote", "foreign.safetensors", "{weights}"),),
        before=lambda: write_tensors(Path("foreign.safetensors"), {"a": torch.zeros(1)}, {}),
    ),
    Row(
        "--rgb and --depth belong together",
        "train weaver --recordings {walk} --weights {weights} --rgb {rgb} --out out",
        (add("--depth", "{depth}"),),
    ),
    Row(
        "--learning-rate must be above 0",
        f"{TRAIN} --learning-rate 0",
        (instead("above 0", "--learning-rate 0", "--learning-rate 0.001"),),
    ),
    Row("--save-every must be 0 or more seconds", f"{TRAIN} --save-every -1", (instead("0 or more", "-1", "0"),)),
    # others
)
