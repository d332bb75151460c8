"""Frozen dataclasses of tensors or arrays that are moved, stacked, joined and indexed as one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from torch import Tensor

RecordT = TypeVar("RecordT", bound="TensorRecord")


@dataclass(frozen=True, kw_only=True)
class TensorRecord:
    """Base of records whose fields are tensors, or numpy arrays, that share their leading axes.

    Operations apply to every one and to nested records; None and other values stay as they are, taken from the first
    record where several are combined.

    >>> import torch
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Track(TensorRecord):
    ...     range_m: torch.Tensor  # (frame,)
    >>> both = Track.cat([Track(range_m=torch.ones(2)), Track(range_m=torch.zeros(3))])
    >>> both.range_m.shape, both[1:].range_m.shape
    (torch.Size([5]), torch.Size([4]))
    """

    def map(self: RecordT, function: Callable[["Tensor"], "Tensor"]) -> RecordT:
        """Applies a function to each tensor.

        Args:
            function: Maps a tensor to a tensor.

        Returns:
            The record of results.
        """
        values = {name: _mapped(getattr(self, name), function) for name in self.__dataclass_fields__}
        return type(self)(**values)  # `replace` takes twice as long

    def to(self: RecordT, *target: Any, **options: Any) -> RecordT:
        """Moves or converts each tensor; arguments are those of `Tensor.to`."""
        return self.map(lambda tensor: tensor.to(*target, **options))

    def __getitem__(self: RecordT, index: Any) -> RecordT:
        """Indexes each tensor along the shared leading axes."""
        return self.map(lambda tensor: tensor[index])

    @classmethod
    def stack(cls: type[RecordT], records: Sequence[RecordT]) -> RecordT:
        """Records of tensors of equal shapes along a new leading axis."""
        import torch

        return _combined(records, torch.stack)

    @classmethod
    def cat(cls: type[RecordT], records: Sequence[RecordT], dim: int = 0) -> RecordT:
        """Concatenates records along a shared axis.

        Args:
            records: Records of one type.
            dim: Axis, counted from the front. Default: 0.

        Returns:
            The combined record.
        """
        import torch

        return _combined(
            records, lambda parts: (np.concatenate if isinstance(parts[0], np.ndarray) else torch.cat)(parts, dim)
        )


def _mapped(value: Any, function: Callable[["Tensor"], "Tensor"]) -> Any:
    import torch

    if isinstance(value, TensorRecord):
        return value.map(function)
    return function(value) if isinstance(value, (torch.Tensor, np.ndarray)) else value


def _combined(records: Sequence[RecordT], join: Callable[[list[Any]], Any]) -> RecordT:
    import torch

    first = records[0]
    values = {}
    for name in first.__dataclass_fields__:
        each = [getattr(record, name) for record in records]
        if isinstance(each[0], TensorRecord):
            values[name] = _combined(each, join)
        else:
            values[name] = join(each) if isinstance(each[0], (torch.Tensor, np.ndarray)) else each[0]
    return type(first)(**values)
