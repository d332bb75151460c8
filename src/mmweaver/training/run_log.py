"""What a training leaves to look at: a line of figures now and then, pictures, and TensorBoard's files."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError

ROW_EVERY = 50  # steps
LOG, PICTURES, BOARD = "log.jsonl", "pictures", "tensorboard"


class RunLog:
    """log.jsonl, pictures/ and, where asked for, tensorboard/ in the folder of a run.

    `done` steps were made before; what an interrupted run wrote of later ones goes. Raises InputError where TensorBoard
    is asked for and not installed.
    """

    def __init__(self, out: Path, done: int, *, tensorboard: bool = False):
        self.out, self.file = out, out / LOG
        self.board = _writer(out / BOARD, done) if tensorboard else None
        if self.file.is_file():
            kept = [line for line in self.file.read_text(encoding="utf-8").splitlines() if _step_of(line) <= done]
            with atomic_file(self.file) as temporary:
                temporary.write_text("".join(f"{line}\n" for line in kept), encoding="utf-8")

    def row(self, figures: dict[str, Any]) -> None:
        """One step's figures; most are passed over."""
        step = figures["step"]
        if step % ROW_EVERY and figures["validation"] is None:
            return
        with self.file.open("a") as log:
            log.write(json.dumps(figures) + "\n")
        if self.board is not None:
            for name, value in _scalars(figures).items():
                self.board.add_scalar(name, value, step)
            self.board.flush()

    def picture(self, step: int, image: np.ndarray) -> None:
        """A picture (row, column, 3) uint8 of that step."""
        from PIL import Image

        with atomic_file(self.out / PICTURES / f"step_{step:06d}.png") as temporary:
            Image.fromarray(image).save(temporary, "PNG")
        if self.board is not None:
            self.board.add_image("validation", image, step, dataformats="HWC")

    def close(self) -> None:
        """Nothing more is written."""
        if self.board is not None:
            self.board.close()


def _scalars(figures: dict[str, Any]) -> dict[str, float]:
    """{"loss": 1, "terms": {"a": 1}} -> {"loss": 1, "terms/a": 1}; what is None is left out."""
    flat: dict[str, float] = {}
    for name, value in figures.items():
        if isinstance(value, dict):
            flat |= {f"{name}/{part}": own for part, own in value.items()}
        elif value is not None and name not in ("step", "steps"):
            flat[name] = value
    return flat


def _step_of(line: str) -> float:
    try:
        return float(json.loads(line)["step"])
    except (ValueError, KeyError, TypeError):
        return float("inf")  # half a line, from a process that was killed


def _writer(folder: Path, done: int) -> Any:
    try:
        from torch.utils.tensorboard import SummaryWriter
    except ImportError:
        raise InputError("--tensorboard needs TensorBoard; install it with: pip install 'mmweaver[training]'") from None
    return SummaryWriter(str(folder), purge_step=done + 1 if done else None)
