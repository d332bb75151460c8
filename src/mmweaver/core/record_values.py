"""Conversion of JSON values to the fields of frozen records, with one-line errors.

Display of records: sizes and spans instead of arrays, as one line or as a table in a notebook.
"""

import dataclasses
import html
from types import UnionType
from typing import Any, get_args, get_origin

import numpy as np

from mmweaver.core.errors import InputError


class ShownByFacts:
    """Base of records whose repr shows a few facts instead of all values."""

    def facts(self) -> dict[str, str]:
        """Short facts by name, such as sizes and spans."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}: {value}' for name, value in self.facts().items())})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in self.facts().items()
        )
        return f"<table><caption>{html.escape(type(self).__name__)}</caption>{rows}</table>"


def span(values: object, unit: str, decimals: int = 2) -> str:
    """Formats length, first and last value of an axis.

    Args:
        values: Values of the axis, (n,).
        unit: Unit that is appended.
        decimals: Number of decimals. Default: 2.

    Returns:
        Text such as "3, 0.70 to 3.48 m".

    >>> import numpy as np
    >>> span(np.array([0.7, 1.0, 3.48]), "m")
    '3, 0.70 to 3.48 m'
    >>> span(np.zeros(0), "m")
    '0'
    """
    import numpy as np

    axis = np.asarray(values)
    return f"{len(axis)}, {axis[0]:.{decimals}f} to {axis[-1]:.{decimals}f} {unit}" if len(axis) else "0"


def record_fields(cls: Any, values: dict[str, Any], place: str, *, partial: bool = False) -> dict[str, Any]:
    """Converts JSON values to the arguments of a dataclass.

    Args:
        cls: The dataclass; fields are int, bool, str, float, tuples of these, tables (np.ndarray), or these | None.
        values: Values by field name; JSON has lists and integers where the record has tuples and floats.
        place: Name of the source for error messages.
        partial: Whether required fields may be missing. Default: False.

    Returns:
        Values in the types of the fields.

    Raises:
        InputError: If a key is unknown or missing, or a value has another type.
    """
    fields = {field.name: field for field in dataclasses.fields(cls)}
    if unknown := sorted(set(values) - set(fields)):
        raise InputError(f"{place}: unknown key {', '.join(unknown)[:100]}")
    no_default = dataclasses.MISSING
    required = {name for name, one in fields.items() if one.default is no_default and one.default_factory is no_default}
    if (missing := sorted(required - set(values))) and not partial:
        raise InputError(f"{place}: missing key {', '.join(missing)}")
    found = {}
    for name, value in values.items():
        try:
            found[name] = _coerced(fields[name].type, value)
        except (ValueError, OverflowError):
            raise InputError(f"{place}: {name} cannot be {str(value)[:100]!r}") from None
    return found


def _coerced(kind: Any, value: Any) -> Any:
    arguments = get_args(kind)
    if isinstance(kind, UnionType):
        return _coerced(arguments[0], value)
    if kind is float and type(value) in (int, float):
        return float(value)
    if kind in (int, bool, str) and type(value) is kind:
        return value
    if kind is np.ndarray and isinstance(value, list) and _is_numbers(value):
        return np.asarray(value, float)
    if get_origin(kind) is tuple and isinstance(value, list):
        kinds = arguments[:1] * len(value) if arguments[-1] is Ellipsis else arguments
        return tuple(_coerced(one, part) for one, part in zip(kinds, value, strict=True))
    raise ValueError


def _is_numbers(value: Any) -> bool:
    return all(map(_is_numbers, value)) if isinstance(value, list) else type(value) in (int, float)
