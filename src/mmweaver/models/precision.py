"""Geometry inside a network stays in float32, whatever the precision of the rest.

bf16 has three digits: it would move a wall by centimetres.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import wraps
from typing import Any, TypeVar

import torch
from torch import Tensor

Function = TypeVar("Function", bound=Callable[..., Any])


def full_precision(function: Function) -> Function:
    """The function with mixed precision turned off, and what comes to it in bf16 made float32."""

    @wraps(function)
    def exact(*arguments: Any) -> Any:
        with exactly(next(argument for argument in arguments if isinstance(argument, Tensor))):
            return function(*(_exact(argument) for argument in arguments))

    return exact  # type: ignore


def exactly(values: Tensor) -> AbstractContextManager[Any]:
    """Mixed precision turned off on the device of some values."""
    device = values.device.type
    return torch.autocast(device, enabled=False) if torch.amp.is_autocast_available(device) else nullcontext()


def _exact(argument: Any) -> Any:
    return argument.float() if isinstance(argument, Tensor) and argument.dtype == torch.bfloat16 else argument
