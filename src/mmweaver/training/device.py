"""Device, precision and process rank of a training."""

import os
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import torch
from torch import Tensor, nn

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

PRECISIONS = ("auto", "float32", "bf16")
CPU = torch.device("cpu")
Share = tuple[int, int]  # (rank, number of processes)


@dataclass(frozen=True, kw_only=True)
class ComputeDevice:
    """One process of a training: single by default; `ComputeDevice.chosen` joins the processes of torchrun."""

    device: torch.device = CPU
    precision: str = "float32"
    share: Share = (0, 1)
    accelerator: Any = None  # accelerate.Accelerator if there are several processes

    @classmethod
    def chosen(cls, device: str = "auto", precision: str = "auto") -> "ComputeDevice":
        """Selects device and precision.

        Under `torchrun` the processes join, each on its own GPU or all on CPUs.

        Args:
            device: Torch device; "auto" selects a GPU if available.
            precision: "float32", "bf16", or "auto" for bf16 on a GPU. Default: "auto".

        Returns:
            The device of this process.

        Raises:
            InputError: If the device is unavailable, or the precision unknown.
        """
        if precision not in PRECISIONS:
            raise InputError(f"precision must be one of {', '.join(PRECISIONS)}, not {precision!r}")
        place = _device(device)
        accelerator, share = None, (0, 1)
        if int(os.environ.get("WORLD_SIZE", "1")) > 1:
            accelerator = _accelerator(place)
            place, share = accelerator.device, (accelerator.process_index, accelerator.num_processes)
        if precision == "auto":
            precision = "bf16" if place.type == "cuda" else "float32"
        return cls(device=place, precision=precision, share=share, accelerator=accelerator)

    @property
    def is_first(self) -> bool:
        """Whether this process writes files and reports progress."""
        return self.share[0] == 0

    def joined(self, module: nn.Module) -> nn.Module:
        """Wraps a module such that gradients are averaged over all processes."""
        return module if self.accelerator is None else self.accelerator.prepare_model(module)

    def mean(self, values: Tensor) -> Tensor:
        """Averages a tensor over all processes; the result is identical in each."""
        return values if self.accelerator is None else self.accelerator.reduce(values, reduction="mean")

    def wait(self) -> None:
        """Blocks until all processes have arrived."""
        if self.accelerator is not None:
            self.accelerator.wait_for_everyone()

    def arithmetic(self) -> AbstractContextManager[Any]:
        """Autocast context: matrix products in the chosen precision, everything else in float32."""
        return torch.autocast(self.device.type, torch.bfloat16, enabled=self.precision == "bf16")

    def moved(self, batch: Any) -> Any:
        """Moves a batch (tensors in dataclasses, lists, tuples and dicts) to the device of this process."""
        return moved(batch, self.device)


def moved(batch: Any, device: torch.device) -> Any:
    """Moves all tensors of a batch to a device.

    Args:
        batch: Tensors, nested in dataclasses, lists, tuples and dicts.
        device: The device.

    Returns:
        The batch; other values are kept.

    >>> moved({"a": [torch.zeros(2)], "b": "name"}, torch.device("meta"))["a"][0].device.type
    'meta'
    """
    if isinstance(batch, Tensor):
        return batch.to(device)
    if is_dataclass(batch) and not isinstance(batch, type):
        return type(batch)(**{field.name: moved(getattr(batch, field.name), device) for field in fields(batch)})
    if isinstance(batch, dict):
        return {name: moved(value, device) for name, value in batch.items()}
    if isinstance(batch, list | tuple):
        return type(batch)(moved(value, device) for value in batch)
    return batch


def _device(name: str) -> torch.device:
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    try:
        device = torch.device(name)
        torch.zeros(1, device=device)
    except Exception as error:
        reason = str(error).splitlines()[0][:120]
        raise InputError(f"device {name!r} cannot be used here ({reason}); take auto or cpu") from None
    return device


def _accelerator(device: torch.device) -> Any:
    need("training", "training in several processes", "accelerate")
    from accelerate import Accelerator

    return Accelerator(cpu=device.type == "cpu")
