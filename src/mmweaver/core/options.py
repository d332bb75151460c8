"""Options as typed fields: one dataclass is the source of command line, TOML file and Python keywords alike."""

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
    """Makes a class of typed fields a frozen dataclass whose fields are given by name."""
    return dataclasses.dataclass(frozen=True, kw_only=True)(own)


def option(text: str, metavar: str | None = None, *, default: Any = None, **more: Any) -> Any:
    """A field that is an option.

    Args:
        text: what it is, in one line, with its unit.
        metavar: how a value is written, such as X,Y.
        default: the value where it is not given; MISSING if it must be given.
        more: `name` on the command line (default: that of the field); `short`, such as "-o"; `kind`, the type of one
            value, or what makes it of a word, where the annotation does not say it; `many`, several values; `group`,
            the title of the group of options that begins here; `rare`, shown by --help-all alone; `positional`;
            `is_setting`, False for what concerns how or where a run writes rather than what it makes.
    """
    return dataclasses.field(default=default, metadata={"help": text, "metavar": metavar, **more})


def options_of(asked: Any) -> list["dataclasses.Field[Any]"]:
    """The options of a dataclass or of its instance: its own first, then those of its bases from left to right."""
    own = asked if isinstance(asked, type) else type(asked)
    fields = {one.name: one for one in dataclasses.fields(own) if "help" in one.metadata}
    names = dict.fromkeys(name for base in own.__mro__ for name in vars(base).get("__annotations__", ()))
    return [fields[name] for name in names if name in fields]


def option_name(one: "dataclasses.Field[Any]") -> str:
    """The name on the command line, without dashes in front."""
    return one.metadata.get("name") or one.name.replace("_", "-")


def option_kind(one: "dataclasses.Field[Any]") -> tuple[Any, bool]:
    """The type of one value, and whether there may be several."""
    kind = one.metadata.get("kind") or one.type
    if get_origin(kind) in (Union, UnionType):
        kind = next(member for member in get_args(kind) if member is not NoneType)
    is_list = get_origin(kind) is list
    return (get_args(kind)[0] if is_list else kind), one.metadata.get("many", is_list)


def read_word(one: "dataclasses.Field[Any]", word: str) -> Any:
    """One value of an option. Raises InputError for a word that is none."""
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
    """The value of an option in JSON or TOML: numbers, texts, lists of them. Raises InputError for another."""
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
    """The values of an option KEY=VALUE. Raises InputError for a key that is not among `kinds`, or a bad value."""
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
    """A value as `read_word` reads it."""
    if not isinstance(value, tuple | list):
        return str(getattr(value, "words", value))
    if len(value) > 1 and isinstance(value[0], str) and isinstance(value[1], tuple):
        return f"{value[0]}={write_word(value[1])}"
    is_nested = any(isinstance(one, tuple | list) for one in value)
    return (" " if is_nested else ",").join(map(write_word, value))


def given_values(asked: Any) -> "dict[str, tuple[dataclasses.Field[Any], list[Any]]]":
    """The values of all options that differ from their default, by name on the command line."""
    found = {}
    for one in options_of(asked):
        value = getattr(asked, one.name)
        if value is None or value == one.default:
            continue
        is_many = option_kind(one)[1] and isinstance(value, list | tuple) and not _is_single(one, value)
        found[option_name(one)] = one, list(value) if is_many else [value]
    return found


def _is_single(one: "dataclasses.Field[Any]", value: Any) -> bool:
    """Whether the value of an option with several values is one of them, such as a place of a single person."""
    return get_origin(option_kind(one)[0]) is tuple and not any(isinstance(part, list | tuple) for part in value)


def command_words(asked: Any) -> list[str]:
    """The options as words of a command line."""
    words = []
    for name, (one, values) in given_values(asked).items():
        for word in [write_word(value) for value in values if value is not None]:
            if option_kind(one)[0] is bool:
                words.append(f"--{name}")
            else:
                words += [f"--{name}={word}"] if word.startswith("-") else [f"--{name}", word]
    return words


def keywords_of(asked: Any, *without: str) -> Callable[[FunctionT], FunctionT]:
    """Gives a function's last parameter, `**asked`, the signature of a dataclass's fields."""

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
