"""Checks of arrays read from a file: dtype, shape, equal lengths, finite and plausible values."""

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import Place

_WORDS = {"f": "real numbers", "fiu": "real numbers", "iu": "whole numbers", "c": "complex numbers"}


def real_numbers(path: Place | str, name: str, values: np.ndarray) -> np.ndarray:
    """Converts an array from a file to float64.

    Args:
        path: The file, for error messages.
        name: Name of the array.
        values: The array; nan is allowed.

    Returns:
        The array as float64.

    Raises:
        InputError: If it contains anything but real numbers, or infinity.
    """
    return ArrayChecks(path).numbers(name, values, nan=True).astype(np.float64)


class ArrayChecks:
    """Checks the arrays of one file; axes of the same name must have the same length in all of them."""

    def __init__(self, path: Place | str):
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
        """Checks dtype, shape and range of an array.

        Args:
            name: Name in error messages.
            values: The array.
            shape: One length or axis name per axis; axes of the same name have the same length in all arrays of the
                file. Default: any shape.
            kinds: Allowed dtype kinds, as numpy's letters. Default: real numbers.
            low: Smallest allowed value; for complex numbers, of real and imaginary part.
            high: Largest allowed value.
            nan: Whether nan is allowed. Default: False.

        Returns:
            `values`, unchanged.

        Raises:
            InputError: If it has another dtype or shape, is not finite, or out of range.
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
        """Checks a shape.

        Args:
            name: Name in error messages.
            found: Actual shape.
            wanted: Expected shape, as in `numbers`.

        Raises:
            InputError: If they differ.
        """
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
        least, most = values.min(), values.max()  # nan propagates
        if not (np.isfinite(least) and np.isfinite(most)):
            raise InputError(f"{self.path}: {name} holds values that are not finite; write the file again without them")
        if least < low or most > high:
            raise InputError(
                f"{self.path}: {name} runs from {float(least):.4g} to {float(most):.4g}, outside {low:g} to {high:g};"
                " is the unit right?"
            )
