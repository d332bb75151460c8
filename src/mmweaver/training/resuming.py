"""Interruptible training: state is saved regularly, and training resumes from it."""

import io
import logging
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import torch

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_tensors import read_checkpoint

SAVE_EVERY_S = 60.0
log = logging.getLogger(__name__)


class Resumable:
    """Counts steps, saves the state of a run regularly, and resumes a saved run.

    Of several processes all load and one saves. A run resumes with its original number of threads, since sums over
    another number of threads differ in their last bits.
    """

    def __init__(self, file: Path | None, parts: dict[str, Any], *, every_s: float | None = None, writes: bool = True):
        """Loads the state if the file exists.

        Args:
            file: Checkpoint; None to save nothing.
            parts: Objects with `state_dict` and `load_state_dict`, by name.
            every_s: Seconds between checkpoints. Default: 60.
            writes: Whether this process saves. Default: True.

        Raises:
            InputError: If the checkpoint is damaged or has other settings.
        """
        self.file, self.parts, self.every_s, self.writes = file, parts, every_s, writes
        self.done = 0
        self.history: list[dict[str, float]] = []
        self._is_last = False
        if file is not None and file.is_file():
            self._load(file)

    def steps(self, most: int) -> Iterator[int]:
        """Iterates over the remaining steps and saves the state in between.

        Args:
            most: Total number of steps.

        Yields:
            Number of completed steps.
        """
        every_s = SAVE_EVERY_S if self.every_s is None else self.every_s
        saved = time.monotonic()
        while self.done < most and not self._is_last:
            yield self.done
            self.done += 1
            if time.monotonic() - saved > every_s or self.done == most or self._is_last:
                self._save()
                saved = time.monotonic()

    def stop(self) -> None:
        """Makes the current step the last one."""
        self._is_last = True

    def _save(self) -> None:
        if self.file is None or not self.writes:
            return
        states = {name: part.state_dict() for name, part in self.parts.items()}
        state = {"done": self.done, "history": self.history, "parts": states}
        packed = io.BytesIO()  # torch.save to a full disk raises errors of many types
        torch.save(state | {"threads": torch.get_num_threads()}, packed)
        with atomic_file(self.file) as temporary:
            temporary.write_bytes(packed.getbuffer())

    def _load(self, file: Path) -> None:
        saved = read_checkpoint(file, what="no checkpoint ({reason}); delete it to start over")
        try:
            for name, part in self.parts.items():
                part.load_state_dict(saved["parts"][name])
        except Exception as error:
            raise InputError(
                f"{file} cannot be resumed ({str(error).splitlines()[0][:80]}); delete it to start over"
            ) from None
        self.done, self.history = saved["done"], saved["history"]
        _use_threads(int(saved.get("threads", torch.get_num_threads())), file)  # missing in older files


def _use_threads(threads: int, file: Path) -> None:
    if threads != torch.get_num_threads():
        log.warning("%s was written with %d threads; training resumes with %d", file, threads, threads)
        torch.set_num_threads(threads)
