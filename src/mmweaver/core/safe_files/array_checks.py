"""Checks of arrays that came out of a file: type, shape, equal lengths, finite and plausible values."""

from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError

_WORDS = {"f": "real numbers", "fiu": "real numbers", "iu": "whole numbers", "c": "complex numbers"}


def real_numbers(path: Path | str, name: str, values: np.ndarray) -> np.ndarray:
    """An array of a file as float64; NaN is allowed. Raises InputError where it holds anything but real numbers."""
    return ArrayChecks(path).numbers(name, values, nan=True).astype(np.float64)


class ArrayChecks:
    """Checks arrays of one file. Axes of one name have one length in all of them."""

    def __init__(self, path: Path | str):
        self.path = path
        self._lengths: dict[str, tuple[int, str]] = {}

    def numbers(
        self,
        name: str,
        values: np.ndarray,
        shape: tuple[int | str, ...] | None = None,
        *,
        kinds: str = "fiu",
        low: int | float = -np.inf,
        high: int | float = np.inf,
        nan: bool = False,
    ) -> np.ndarray:
        """Checks type, shape and range of an array of numbers.

        Args:
            name: What it is called in errors.
            values: The array.
            shape: A length or a name per axis; a name has one length in all arrays of the file. Default: any.
            kinds: Letters of numpy for the types that are allowed.
            low: Smallest value; of complex numbers of either part.
            high: Largest value.
            nan: Whether NaN is allowed.

        Returns:
            `values`.

        Raises:
            InputError: where it is of another type or shape, not finite, or out of range.
        """
        if values.dtype.kind not in kinds:
            raise InputError(
                f"{self.path}: {name} is of type {values.dtype}; it must hold {_WORDS.get(kinds, 'numbers')}"
            )
        if shape is not None:
            self.shape(name, values.shape, shape)
        if values.size and values.dtype.kind in "fc":
            for part in (np.real(values), np.imag(values)) if values.dtype.kind == "c" else (values,):
                self._check_range(name, part, low, high, nan)
        elif values.size:
            self._check_range(name, values, low, high, nan)
        return values

    def shape(self, name: str, found: tuple[int, ...], wanted: tuple[int | str, ...]) -> None:
        """Raises InputError where the shape `found` of an array is not `wanted`, as in `numbers`."""
        words = f"({', '.join(str(axis) for axis in wanted)})"
        if len(found) != len(wanted):
            raise InputError(f"{self.path}: {name} has shape {found}; it must be {words}")
        for axis, length in zip(wanted, found, strict=True):
            if isinstance(axis, int):
                if axis != length:
                    raise InputError(f"{self.path}: {name} has shape {found}; it must be {words}")
                continue
            known, first = self._lengths.setdefault(axis, (length, name))
            if known != length:
                raise InputError(
                    f"{self.path}: {name} has {length} along {axis!r}, but {first} has {known}; write the file again"
                )

    def _check_range(self, name: str, values: np.ndarray, low: int | float, high: int | float, nan: bool) -> None:
        if nan:
            values = values[~np.isnan(values)]
            if not values.size:
                return
        least, most = values.min(), values.max()  # NaN if any is NaN
        if not (np.isfinite(least) and np.isfinite(most)):
            raise InputError(f"{self.path}: {name} holds values that are not finite; write the file again without them")
        if least < low or most > high:
            raise InputError(
                f"{self.path}: {name} runs from {float(least):.4g} to {float(most):.4g}, outside {low:g} to {high:g};"
                " is the unit right?"
            )
