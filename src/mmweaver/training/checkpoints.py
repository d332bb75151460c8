"""Checkpoints that training can go on from exactly, without pickle: tensors as safetensors, the rest as JSON."""

import json
import shutil
from pathlib import Path
from typing import Any

import torch
from torch import nn

from mmweaver.core.errors import InputError

STATE_FILE = "state.json"


def save_checkpoint(folder: Path, model: nn.Module, optimiser: torch.optim.Optimizer, state: dict[str, Any]) -> None:
    """Replaces the checkpoint in `folder`; a kill while writing leaves the old one."""
    from safetensors.torch import save_file

    partial, old = folder.with_name(folder.name + ".new"), folder.with_name(folder.name + ".old")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    save_file({name: tensor.contiguous() for name, tensor in model.state_dict().items()}, partial / "model.safetensors")
    moments, counts = {}, {}
    for index, values in optimiser.state_dict()["state"].items():
        for name, value in values.items():
            if isinstance(value, torch.Tensor) and value.dim() > 0:
                moments[f"{index}.{name}"] = value.contiguous()
            else:
                counts[f"{index}.{name}"] = float(value)
    save_file(moments, partial / "optimiser.safetensors")
    (partial / STATE_FILE).write_text(json.dumps({**state, "optimiser_counts": counts}))
    shutil.rmtree(old, ignore_errors=True)
    if folder.exists():
        folder.rename(old)
    partial.rename(folder)
    shutil.rmtree(old, ignore_errors=True)


def load_checkpoint(folder: Path, model: nn.Module, optimiser: torch.optim.Optimizer) -> dict[str, Any] | None:
    """Puts a checkpoint into the model and the optimiser and gives its state; None where there is none.

    A kill between two renames leaves only the old one, which is taken. Raises InputError where it is damaged or of
    another network.
    """
    from safetensors.torch import load_file

    if not (folder / STATE_FILE).is_file():
        folder = folder.with_name(folder.name + ".old")
    if not (folder / STATE_FILE).is_file():
        return None
    try:
        state = json.loads((folder / STATE_FILE).read_text())
        model.load_state_dict(load_file(folder / "model.safetensors"))
        moments = load_file(folder / "optimiser.safetensors")
    except Exception as error:
        raise InputError(f"the checkpoint {folder} cannot be gone on from ({error}); remove it to start anew") from None
    whole = optimiser.state_dict()
    values: dict[int, dict[str, Any]] = {}
    for key, tensor in moments.items():
        index, name = key.split(".", 1)
        values.setdefault(int(index), {})[name] = tensor
    for key, number in state.pop("optimiser_counts").items():
        index, name = key.split(".", 1)
        values.setdefault(int(index), {})[name] = torch.tensor(number)
    optimiser.load_state_dict({**whole, "state": values})
    return state
