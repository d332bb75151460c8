"""Keeps geometry inside a network in float32, whatever the precision of the rest.

bf16 has three significant digits, which would move a wall by centimetres.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import wraps
from typing import Any, TypeVar

import torch
from torch import Tensor

Function = TypeVar("Function", bound=Callable[..., Any])


def full_precision(function: Function) -> Function:
    """Decorator that turns mixed precision off, and converts bf16 arguments to float32."""

    @wraps(function)
    def exact(*arguments: Any) -> Any:
        with exactly(next(argument for argument in arguments if isinstance(argument, Tensor))):
            return function(*(_exact(argument) for argument in arguments))

    return exact  # type: ignore


def exactly(values: Tensor) -> AbstractContextManager[Any]:
    """Context with mixed precision turned off on the device of `values`."""
    device = values.device.type
    return torch.autocast(device, enabled=False) if torch.amp.is_autocast_available(device) else nullcontext()


def _exact(argument: Any) -> Any:
    return argument.float() if isinstance(argument, Tensor) and argument.dtype == torch.bfloat16 else argument
