"""Advice about data sets, training, recognisers and what else takes long: up to where the work would begin."""

import json
import shutil
from pathlib import Path

import torch
from PIL import Image

from mmweaver.cli.main import main
from mmweaver.core.tensor_files import write_tensors
from mmweaver.formats.dca1000 import write_bin
from tests.advice.harness import Row, add, drop, edit, first, instead, plus
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
        f"{ROOMS} --each 2",
        (
            instead(
                "give --activities",
                "--layouts 1 --sequences 1",
                "--activities {activities} --rgb {rgb} --depth {depth}",
            ),
        ),
    ),
    Row(
        "is for data sets of rooms; leave it out",
        f"{SET} --rgb {{rgb}} --depth {{depth}} --layouts 3",
        (instead("leave it out", "--layouts 3"),),
    ),
    Row(
        "--from-results takes sequences as they are", "dataset out --from-results {results} --each 2", (drop("--each"),)
    ),
    Row(
        "give --room folders or --rgb and --depth, not both",
        f"{SET} --room {{own_room}} --rgb {{rgb}} --depth {{depth}}",
        (
            drop("--room"),
            drop("--rgb", "--depth"),
        ),
    ),
    Row("--rgb needs --depth, too", f"{SET} --rgb {{rgb}}", (add("--depth", "{depth}"),)),
    Row(
        "which room? give --room DIR",
        SET,
        (
            add("--room", "{own_room}"),
            instead("or --rgb and --depth", "--dry-run", "--dry-run --rgb {rgb} --depth {depth}"),
        ),
    ),
    Row(
        "give what mmweaver generate --texts wrote",
        "dataset out --from-results {nothing}",
        (instead("give what mmweaver generate --texts wrote", "{nothing}", "{results}"),),
    ),
    Row(
        "is a sentence of no activity",
        "dataset out --from-results {results} --activities {jumping}",
        (
            drop("--activities"),
            instead("add it to one", "{jumping}", "{activities}"),
        ),
    ),
    # training: the options and what is read alone
    Row(
        "□ has no photo of its room",
        "train weaver --captures capture --from {weights} --out out",
        (
            edit("put rgb.png, depth.png (or depth.npy) and camera.json into it", lambda: _photo("capture")),
            edit("or into the folder above", lambda: _photo(".")),
            plus("give --rgb and --depth", "--rgb", "{rgb}", "--depth", "{depth}", "--camera", "{camera}"),
        ),
        before=_capture,
    ),
    Row(
        "has changed since □ was written",
        "train weaver --captures capture --from {weights} --out out",
        (plus("give --rgb and --depth", "--rgb", "{rgb}", "--depth", "{depth}", "--camera", "{camera}"),),
        before=_capture_of_another_photo,
    ),
    Row(
        "is not a weight file of mmweaver; give one that",
        "train weaver --captures {walk} --from foreign.safetensors --out out",
        (instead("give one that mmweaver train wrote", "foreign.safetensors", "{weights}"),),
        before=lambda: write_tensors(Path("foreign.safetensors"), {"a": torch.zeros(1)}, {}),
    ),
    Row("what to train on? give --data", "train weaver --out out", (add("--data", "{walk}"),)),
    Row(
        "--captures fine-tunes existing weights",
        "train weaver --captures {walk} --out out",
        (add("--from", "{weights}"),),
    ),
    Row(
        "--encoder is for recipe weaver on --data",
        "train weaver --captures {walk} --from {weights} --encoder none --out out",
        (drop("--encoder"),),
    ),
    Row(
        "--rgb, --depth and --camera are the photo of --captures",
        f"{TRAIN} --rgb {{rgb}} --depth {{depth}}",
        (instead("are the photo of --captures", "--rgb {rgb} --depth {depth}"),),
    ),
    Row(
        "--rgb and --depth belong together",
        "train weaver --captures {walk} --from {weights} --rgb {rgb} --out out",
        (add("--depth", "{depth}"),),
    ),
    Row(
        "--learning-rate must be above 0",
        f"{TRAIN} --learning-rate 0",
        (instead("above 0", "--learning-rate 0", "--learning-rate 0.001"),),
    ),
    Row("--save-every must be 0 or more seconds", f"{TRAIN} --save-every -1", (instead("0 or more", "-1", "0"),)),
    Row(
        "train pose needs a task",
        "train pose --out model/",
        (first("mmweaver train pose", lambda *_: [], **{"TASK.toml": "{task}"}),),
    ),
    Row("a task and --sequences are for recipe pose", f"{TRAIN} --sequences 4", (drop("--sequences"),)),
    Row(
        "recipe pose is trained on the sentences of its task",
        "train pose {task} --data {walk} --out out",
        (drop("--data"),),
    ),
    Row(
        "--captures is for recipe weaver; recipe",
        "train activity --captures {walk} --from {weights} --out out",
        (instead("is trained on --data", "--captures {walk} --from {weights}", "--data {walk}"),),
    ),
    # others
    Row(
        "nobody is there: leave out --height",
        "motion nobody --height 1.8",
        (
            drop("--height"),
            instead("say what a person does", "nobody", "'a person waves'"),
        ),
    ),
)
