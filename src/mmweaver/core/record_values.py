"""Conversion of JSON values to the fields of frozen records, with one-line errors."""

import dataclasses
from types import UnionType
from typing import Any, get_args, get_origin

import numpy as np

from mmweaver.core.errors import InputError


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
