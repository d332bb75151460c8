"""The commands that write, as fault injection runs them: small, and with the same bits each time."""

import contextlib
import inspect
import shlex
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from unittest import mock

import mmweaver
from mmweaver.cli.main import main

if TYPE_CHECKING:
    from torch import Tensor

VARYING = ("log.jsonl",)  # its lines say how long they took
DEMO = "generate --demo --quiet --frames 2 --no-pictures --method physics"
DATASET = "--rooms office --layouts 2 --sequences 1 --frames 2 --quiet"
LABELLED = "--per-class 1 --seconds 0.6 --subjects 1 --method physics --quiet"
TRAIN = "train weaver --encoder small --steps 2 --batch 1 --save-every 0 --validate-every 1 --device cpu --quiet"
GENERATED = ("mmweaver.weaver.room_reader:reconstruct", "mmweaver.weaver.composition:compose_request")
ROOMS = tuple(f"mmweaver.scene.procedural.procedural_room:{name}" for name in ("make_room", "ProceduralRoom.photo"))
TRAINED = (
    "mmweaver.training.network_examples:reconstruct", "mmweaver.training.network_examples:power_maps",
    "mmweaver.training.network_training:draw_sheet",
)  # fmt: skip


@dataclass(frozen=True)
class FaultedCommand:
    """A command line that writes into OUT; `before` makes what it overwrites; a resumable one keeps finished work.

    One that `grows` is not run twice: whole parts are kept, and the same folder is refused. One that `appends` to
    .mmw files keeps what they held and whole records, and adds its own once more when it is run again.
    `computes`: "module:function" of long computations that write nothing; each is done once, and every run takes its
    result, which follows from the arguments. `smaller`: what makes others short.
    """

    name: str
    line: str
    before: str | None = None
    is_resumable: bool = False
    grows: bool = False
    appends: bool = False
    varying: tuple[str, ...] = VARYING
    computes: tuple[str, ...] = ()
    smaller: Callable[[], contextlib.AbstractContextManager[object]] = contextlib.nullcontext

    def run(self, out: Path, line: str | None = None) -> int:
        """Runs it, or another line, in this process; returns its exit status."""
        with self.smaller():
            return main(shlex.split((line or self.line).replace("OUT", str(out))))


def prepare_inputs(inputs: Path, *, which: tuple[str, ...] = ("walk", "walk.mmw", "data")) -> None:
    """Makes what the commands read: sentences, a recording, its .mmw file, and a data set without signals."""
    inputs.mkdir(parents=True, exist_ok=True)
    (inputs / "sentences.txt").write_text("a person waves\na person walks to the left\n", encoding="utf-8")
    activities = '[activities]\nwaving = ["a person waves"]\nsquatting = ["a person squats"]\n'
    (inputs / "activities.toml").write_text(activities, encoding="utf-8")
    made = {
        "walk": f"{DEMO} --text 'a person waves' --bin --out {inputs}/walk",
        "walk.mmw": f"compress {inputs}/walk -o {inputs}/walk.mmw --bytes 3000 --quiet",
        "data": f"dataset {inputs}/data --rooms office,dining_room --layouts 1 --sequences 1 --frames 2 --geometry-only"
                " --quiet",
    }  # fmt: skip
    for name in which:
        if not (inputs / name).exists():
            assert main(shlex.split(made[name])) == 0, made[name]


def faulted_commands(inputs: Path) -> list[FaultedCommand]:
    """Every command that writes; `inputs` as `prepare_inputs` makes them."""
    walk, mmw, texts = f"{inputs}/walk", f"{inputs}/walk.mmw", f"--texts {inputs}/sentences.txt"
    samples = f"{walk}/adc_data.bin --radar {walk}/radar.json --quiet"
    labels = f"--activities {inputs}/activities.toml"
    wave = f"{DEMO} --text 'a person waves'"
    place = Path(mmweaver.__file__).parent / "sample"
    sample = f"--room {place}"

    return [
        FaultedCommand("motion", "motion 'a person waves' --out OUT/m.npz --out OUT/m.png"),
        FaultedCommand("decompress", f"decompress {mmw} -o OUT/d/radar.npz --quiet"),
        FaultedCommand("decompress --overwrite", f"decompress {mmw} -o OUT/radar.npz --quiet --overwrite",
                       before=f"decompress {mmw} -o OUT/radar.npz --quiet --frames 0:1"),
        FaultedCommand("compress", f"compress {walk} -o OUT/a.mmw --bytes 3000 --quiet"),
        FaultedCommand("compress --append", f"compress {walk} -o OUT/a.mmw --bytes 3000 --quiet --append", appends=True,
                       before=f"compress {walk} -o OUT/a.mmw --bytes 3000 --quiet"),
        FaultedCommand("compress --lossless", f"compress {samples} -o OUT/a.mmwl --quality lossless"),
        FaultedCommand("process", f"process {samples} --no-pictures --out OUT/p"),
        FaultedCommand("points", f"points {walk}/points.npz -o OUT/points.npz --quiet"),
        FaultedCommand("export", f"export {walk} --to mars --out OUT/e"),
        FaultedCommand("sample", "sample OUT/s --quiet", computes=GENERATED),
        FaultedCommand("rooms", "rooms OUT/r --rooms office --layouts 1 --quiet", computes=ROOMS),
        FaultedCommand("generate", f"{wave} --out OUT/g", computes=GENERATED),
        FaultedCommand("generate --overwrite", f"{wave} --seed 1 --out OUT/g --overwrite", computes=GENERATED,
                       before=f"{wave} --seed 2 --out OUT/g"),
        FaultedCommand("generate --texts", f"{DEMO} {texts} --out OUT/s", is_resumable=True, computes=GENERATED),
        FaultedCommand("generate --stream", f"{DEMO} --frames 21 {texts} --stream --bin --out OUT/stream", grows=True,
                       computes=GENERATED),
        FaultedCommand("dataset", f"dataset OUT/data {DATASET}", is_resumable=True,
                       computes=("mmweaver.datasets.room_generation:generate_room",)),
        FaultedCommand("dataset --activities", f"dataset OUT/set {labels} {sample} {LABELLED}",
                       is_resumable=True, computes=(*GENERATED, "mmweaver.datasets.build_set:compose_request")),
        FaultedCommand("train", f"{TRAIN} --data {inputs}/data --out OUT/run", is_resumable=True, computes=TRAINED,
                       smaller=small_training),
    ]  # fmt: skip


@contextlib.contextmanager
def small_training() -> Iterator[None]:
    """Trainings validate one batch, and know a small encoder."""
    from torch import nn

    from mmweaver.models.environment_encoder import ENCODERS, MAP_CHANNELS, Z_ENV
    from mmweaver.models.scene_tensors import IMAGE_CHANNELS
    from mmweaver.training.network_training import TrainingRecipe

    class SmallEncoder(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.places = nn.Conv2d(IMAGE_CHANNELS, MAP_CHANNELS, kernel_size=8, stride=8)
            self.project = nn.Linear(MAP_CHANNELS, Z_ENV)

        def forward(self, image: "Tensor") -> "tuple[Tensor, Tensor]":
            places = self.places(image)
            return self.project(places.mean(dim=(2, 3))), places

    if "small" not in ENCODERS:
        ENCODERS.register("small", SmallEncoder)
    with mock.patch.dict(inspect.unwrap(TrainingRecipe.__init__).__kwdefaults__, validation_batches=1):
        yield
