"""Log of a training run: rows of figures, pictures, and TensorBoard files."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import append_line, atomic_file
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.safe_text import parse_json, read_text

ROW_EVERY = 50  # steps
LOG, PICTURES, BOARD = "log.jsonl", "pictures", "tensorboard"


class RunLog:
    """log.jsonl, pictures/ and, if requested, tensorboard/ in the folder of a run."""

    def __init__(self, out: Path, done: int, *, tensorboard: bool = False):
        """Opens the log and drops entries of an interrupted run after its checkpoint.

        Args:
            out: Folder of the run.
            done: Number of completed steps.
            tensorboard: Whether to write TensorBoard files. Default: False.

        Raises:
            InputError: If TensorBoard is requested but not installed.
        """
        self.out, self.file = out, out / LOG
        self.board = _writer(out / BOARD, done) if tensorboard else None
        if self.file.is_file():
            kept = [line for line in read_text(self.file).splitlines() if _step_of(line) <= done]
            with atomic_file(self.file) as temporary:
                temporary.write_text("".join(f"{line}\n" for line in kept), encoding="utf-8")

    def row(self, figures: dict[str, Any]) -> None:
        """Logs the figures of a step if it is a multiple of 50 or has a validation.

        Args:
            figures: Fields of `Progress`.
        """
        step = figures["step"]
        if step % ROW_EVERY and figures["validation"] is None:
            return
        append_line(self.file, json.dumps(figures))
        if self.board is not None:
            for name, value in _scalars(figures).items():
                self.board.add_scalar(name, value, step)
            self.board.flush()

    def picture(self, step: int, image: np.ndarray) -> None:
        """Saves a picture.

        Args:
            step: Number of completed steps.
            image: Picture, (row, column, 3) uint8.
        """
        from PIL import Image

        with atomic_file(self.out / PICTURES / f"step_{step:06d}.png") as temporary:
            Image.fromarray(image).save(temporary, "PNG")
        if self.board is not None:
            self.board.add_image("validation", image, step, dataformats="HWC")

    def close(self) -> None:
        """Closes the TensorBoard files."""
        if self.board is not None:
            self.board.close()


def _scalars(figures: dict[str, Any]) -> dict[str, float]:
    """{"loss": 1, "terms": {"a": 1}} -> {"loss": 1, "terms/a": 1}; None is dropped."""
    flat: dict[str, float] = {}
    for name, value in figures.items():
        if isinstance(value, dict):
            flat |= {f"{name}/{part}": own for part, own in value.items()}
        elif value is not None and name not in ("step", "steps"):
            flat[name] = value
    return flat


def _step_of(line: str) -> float:
    try:
        return float(parse_json(line, "a line of the log")["step"])
    except (ValueError, KeyError, TypeError):
        return float("inf")  # an incomplete line of a killed process


def _writer(folder: Path, done: int) -> Any:
    need("training", "--tensorboard", "tensorboard")
    from torch.utils.tensorboard import SummaryWriter

    return SummaryWriter(str(folder), purge_step=done + 1 if done else None)
