"""Options as typed fields: one dataclass defines command line, TOML file and Python keywords."""

import dataclasses
import inspect
import math
from collections.abc import Callable
from types import NoneType, UnionType
from typing import Any, Literal, NewType, TypeVar, Union, dataclass_transform, get_args, get_origin

from mmweaver.core.errors import InputError

MISSING = dataclasses.MISSING
Source = NewType("Source", str)  # a file or folder, or a name that is known elsewhere: a preset, a name on the Hub
Setting = NewType("Setting", str)  # KEY=VALUE, where the value may be a file
Place = tuple[float, float]
FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])
ClassT = TypeVar("ClassT", bound=type)
_WHAT = {int: "whole number", float: "number"}


@dataclass_transform(kw_only_default=True, frozen_default=True)
def options(own: ClassT) -> ClassT:
    """Class decorator: a frozen, keyword-only dataclass of typed option fields."""
    return dataclasses.dataclass(frozen=True, kw_only=True)(own)


def option(text: str, metavar: str | None = None, *, default: Any = None, **more: Any) -> Any:
    """Declares a dataclass field that is an option.

    Args:
        text: Help text in one line, with the unit.
        metavar: Format of a value, such as X,Y.
        default: Default value; MISSING if the option is required.
        more: `name` on the command line (default: the field's); `short`, such as "-o"; `kind`, type of one value or
            parser of one word if the annotation does not state it; `many`, several values; `group`, title of the group
            of options that starts here; `rare`, listed by --help-all only; `positional`; `is_setting`, False for
            options that affect how or where a run writes rather than its content.

    Returns:
        A dataclass field.
    """
    return dataclasses.field(default=default, metadata={"help": text, "metavar": metavar, **more})


def options_of(asked: Any) -> list["dataclasses.Field[Any]"]:
    """Lists the option fields of a dataclass.

    Args:
        asked: The dataclass or an instance of it.

    Returns:
        Its own options first, then those of its bases from left to right.
    """
    own = asked if isinstance(asked, type) else type(asked)
    fields = {one.name: one for one in dataclasses.fields(own) if "help" in one.metadata}
    names = dict.fromkeys(name for base in own.__mro__ for name in vars(base).get("__annotations__", ()))
    return [fields[name] for name in names if name in fields]


def option_name(one: "dataclasses.Field[Any]") -> str:
    """Name of an option on the command line, without leading dashes."""
    return one.metadata.get("name") or one.name.replace("_", "-")


def option_kind(one: "dataclasses.Field[Any]") -> tuple[Any, bool]:
    """Determines the type of an option.

    Args:
        one: The option.

    Returns:
        Type of one value, and whether the option takes several values.
    """
    kind = one.metadata.get("kind") or one.type
    if get_origin(kind) in (Union, UnionType):
        kind = next(member for member in get_args(kind) if member is not NoneType)
    is_list = get_origin(kind) is list
    return (get_args(kind)[0] if is_list else kind), one.metadata.get("many", is_list)


def read_word(one: "dataclasses.Field[Any]", word: str) -> Any:
    """Parses one value of an option from the command line.

    Args:
        one: The option.
        word: Word of the command line.

    Returns:
        The value in the type of the option.

    Raises:
        InputError: If the word does not parse.
    """
    kind = option_kind(one)[0]
    try:
        return _read(kind, word)
    except InputError:
        raise
    except (ValueError, TypeError):
        raise InputError(f"{word[:60]!r} is no {_WHAT.get(kind) or one.metadata['metavar']}") from None


def _read(kind: Any, word: str) -> Any:
    parts = get_args(kind)
    if get_origin(kind) is not tuple:
        value = getattr(kind, "of_words", kind)(word) if not parts else type(parts[0])(word)
        if (kind is float and not math.isfinite(value)) or (kind is int and abs(value) >= 2**63):
            raise ValueError
        return value
    if parts[-1] is Ellipsis:
        words = word.split() if get_origin(parts[0]) is tuple else word.split(",")
        return tuple(_read(parts[0], one) for one in words)
    words = word.split("=" if parts[0] is str else ",")
    return tuple(_read(part, one.strip()) for part, one in zip(parts, words, strict=True))


def read_value(one: "dataclasses.Field[Any]", value: Any) -> Any:
    """Converts the value of an option from JSON or TOML.

    Args:
        one: The option.
        value: Number, text, boolean, or a list of them.

    Returns:
        The value in the type of the option, or a list for options with several values.

    Raises:
        InputError: If the value has another type or is not among the choices.
    """
    kind, is_many = option_kind(one)
    if kind is bool:
        if not isinstance(value, bool):
            raise InputError(f"{option_name(one)} is true or false, not {value!r}")
        return value
    values = value if is_many and isinstance(value, list) and not _is_single(one, value) else [value]
    types: Any = str if kind is str else int | float | str | list
    if not all(isinstance(each, types) and not isinstance(each, bool) for each in values):
        raise InputError(f"{option_name(one)} cannot be {value!r}")
    try:
        read = [read_word(one, write_word(each)) for each in values]
    except InputError as error:
        raise InputError(f"{option_name(one)}: {error}") from None
    if get_origin(kind) is Literal and not set(read) <= set(get_args(kind)):
        raise InputError(f"{option_name(one)} is one of {', '.join(map(str, get_args(kind)))}")
    return read if is_many else read[0]


def read_settings(given: list[Setting] | None, kinds: dict[str, Any], name: str) -> dict[str, Any]:
    """Parses the values of a KEY=VALUE option.

    Args:
        given: Words KEY=VALUE, or None.
        kinds: Type of the value by key.
        name: Name of the option for error messages.

    Returns:
        Values by key.

    Raises:
        InputError: If a key is unknown or a value does not parse.
    """
    values = {}
    for setting in given or ():
        key, equals, word = setting.partition("=")
        if not equals or key not in kinds:
            raise InputError(f"--{name} {setting[:60]!r}: write KEY=VALUE with one of the keys {', '.join(kinds)}")
        try:
            values[key] = _read(kinds[key], word)
        except (ValueError, TypeError):
            raise InputError(f"--{name} {key}: {word[:60]!r} is no {_WHAT.get(kinds[key], 'such value')}") from None
    return values


def write_word(value: Any) -> str:
    """Formats a value such that `read_word` parses it.

    Args:
        value: Number, text, or (nested) tuple of these.

    Returns:
        Word of the command line.
    """
    if not isinstance(value, tuple | list):
        return str(getattr(value, "words", value))
    if len(value) > 1 and isinstance(value[0], str) and isinstance(value[1], tuple):
        return f"{value[0]}={write_word(value[1])}"
    is_nested = any(isinstance(one, tuple | list) for one in value)
    return (" " if is_nested else ",").join(map(write_word, value))


def given_values(asked: Any) -> "dict[str, tuple[dataclasses.Field[Any], list[Any]]]":
    """Lists the options that differ from their default.

    Args:
        asked: Instance of an options dataclass.

    Returns:
        Field and list of values, by name on the command line.
    """
    found = {}
    for one in options_of(asked):
        value = getattr(asked, one.name)
        if value is None or value == one.default:
            continue
        is_many = option_kind(one)[1] and isinstance(value, list | tuple) and not _is_single(one, value)
        found[option_name(one)] = one, list(value) if is_many else [value]
    return found


def _is_single(one: "dataclasses.Field[Any]", value: Any) -> bool:
    """Whether the value of a multi-value option is a single tuple value, such as the position of one person."""
    return get_origin(option_kind(one)[0]) is tuple and not any(isinstance(part, list | tuple) for part in value)


def command_words(asked: Any) -> list[str]:
    """Formats the options as words of a command line; inverse of parsing.

    Args:
        asked: Instance of an options dataclass.

    Returns:
        Words such as "--radar", "awr1843"; options at their default are omitted.
    """
    words = []
    for name, (one, values) in given_values(asked).items():
        for word in [write_word(value) for value in values if value is not None]:
            if option_kind(one)[0] is bool:
                words.append(f"--{name}")
            else:
                words += [f"--{name}={word}"] if word.startswith("-") else [f"--{name}", word]
    return words


def keywords_of(asked: Any, *without: str) -> Callable[[FunctionT], FunctionT]:
    """Decorator that gives a function's last parameter, `**asked`, the signature of a dataclass's fields.

    Args:
        asked: The dataclass.
        *without: Names of fields that are excluded.

    Returns:
        The decorator.
    """

    def signed(function: FunctionT) -> FunctionT:
        signature = inspect.signature(function)
        *own, _ = signature.parameters.values()
        keywords = [
            inspect.Parameter(one.name, inspect.Parameter.KEYWORD_ONLY, default=one.default, annotation=one.type)
            for one in dataclasses.fields(asked)
            if one.name not in without
        ]
        vars(function)["__signature__"] = signature.replace(parameters=[*own, *keywords])
        return function

    return signed
