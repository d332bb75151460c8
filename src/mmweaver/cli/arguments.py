"""The command line: fields of a dataclass become options, and a TOML file provides those that are not given."""

import argparse
import dataclasses
import difflib
import re
import sys
from functools import partial
from pathlib import Path
from typing import Any, Literal, NoReturn, get_args, get_origin

from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.options import (
    Setting,
    Source,
    given_values,
    option,
    option_kind,
    option_name,
    options,
    options_of,
    read_value,
    read_word,
    write_word,
)

REQUEST_FILE = "request.toml"
HELP_ALL = "--help-all"
# written into request.toml even where they are the default, which may change
ALWAYS_WRITTEN = ("radar", "frames", "seed", "points", "method", "board")
IGNORED_IN_FILES = ("draws", "html", "log-level")  # of 0.2, which do not affect the signal
# defaults of 0.2 that a file may name; switches were off
OLD_DEFAULTS = {"repeat": 1, "motion-model-for": "unknown", "precision": "auto", "lighting": "", "effort": "full"}
# Options of 0.2: their present name, possibly with a key that precedes the value; or what to do instead.
RENAMED = {
    "--empty-room": "--background",
    "--each": "--per-class",
    "--repeat": "--per-class",
    **dict.fromkeys(("--doing", "--body-z"), "a board is calibrated from signals, not from point clouds; leave it out"),
    "--effort": "--preset",
    "--further-photos": "--extra-views",
    "--start": "--weights",
    "--views": "--room",
    "--capture": "--room",
    "--mesh": "--room",
    "--axes": "--layout",
    "--kinds": "--rooms",
    "--moving": "--remove-static=mean_chirp",
    "--subframe": "--radar-set=subframe=",
    "--antennas": "--radar-set=antennas=",
    "--lanes": "--radar-set=lanes=",
    "--motion-model-for": "--motion-set=for=",
    "--body-model": "--motion-set=body=",
    "--clip": "--motion-set=clip=",
    **{f"--motion-{key}": f"--motion-set={key}=" for key in ("fps", "unit", "up", "start")},
    **{f"--mesh-{key}": f"--mesh-set={key}=" for key in ("eye", "look", "unit", "up", "materials")},
    "--html": "make it of the results: mmweaver view DIR --out FILE",
    "--bounces": "--method-set=bounces=",
    "--clutter": "--method-set=clutter=",
    "--draws": "generate sentences that need places of their own alone, with --text",
    "--log-level": "-v logs each stage",
    "--list": "",
    "--store": "a labelled set is made of sentences by mmweaver dataset --activities TOML",
    "--split-by": "--split",
    "--model": "--weights",
    "--from": "--weights",
    "--recording": "PATH",
    "--recogniser": "PATH",
    "--radar-b": "--radar",
    "--labelled": "--recordings",
    "--captures": "--recordings",
    "--quick": "--sequences=8",
    "--picture": "--out",
    "--lossless": "--quality=lossless",
    "--kind": "--layout",
    "--depth-model": "--depth",
    "--segmenter": "--classes",
    "--sam": "refine classes in Python: weaver.read_room(..., sam=NAME)",
    "--max-error": "bound the error in Python: compress_bin(..., max_error=N)",
    "--keep-noise": "keep noise in Python: compress_cube(..., keep_noise=True)",
    "--lighting": "choose the light in Python: make_room(...).photo(LIGHTINGS[NAME])",
    "--precision": "a CPU takes float32, a GPU bf16",
    "--scatterers": "leave the residual out in Python: read_cube(..., with_residual=False)",
}


@options
class General:
    """The options of every command."""

    verbose: bool = option(
        "print every assumption, and log each stage", default=False, short="-v", group="general", is_setting=False
    )
    config: Path | None = option(
        f"read options from a file, such as the {REQUEST_FILE} of an earlier run; options of the command"
        " line take precedence",
        "TOML",
        is_setting=False,
    )


class Parser(argparse.ArgumentParser):
    """argparse that raises InputError instead of exiting."""

    def __init__(self, **settings: Any):
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **settings)
        self._negative_number_matcher = re.compile(r"-([\d.]|[xyz]$)")  # also -0.5,2 and the axis -z are values

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """As argparse, with the nearest choice instead of all where one is near."""
        near = difflib.get_close_matches(str(value), map(str, action.choices or ()), 1)
        if near and value not in (action.choices or ()):
            raise argparse.ArgumentError(action, f"{value!r} is unknown; did you mean {near[0]}?")
        super()._check_value(action, value)


def add_options(parser: Parser, command: type[General], *, rare: bool) -> None:
    """Declares the options of a dataclass; options that are not given are None.

    Args:
        parser: Parser of the command.
        command: The dataclass.
        rare: Whether the help shows rare options.
    """
    groups: dict[str, Any] = {"": parser}
    group: Any = parser
    own = getattr(command, "GROUPS", {})
    hidden = 0
    general = {one.name for one in options_of(General)}
    for one in sorted(options_of(command), key=lambda one: one.name in general):  # these last
        title = own.get(one.name) or one.metadata.get("group")
        if title:
            group = groups[title] = groups.get(title) or parser.add_argument_group(title)
        names, settings = _argument(one)
        if one.metadata.get("rare") and not rare:
            settings["help"] = argparse.SUPPRESS
            hidden += 1
        group.add_argument(*names, **settings)
    if hidden:
        more = f"{hidden} more option{'s' if hidden > 1 else ''}"
        parser.epilog = f"{parser.epilog}\n{more}: {parser.prog} {HELP_ALL}"


def _argument(one: "dataclasses.Field[Any]") -> tuple[list[str], dict[str, Any]]:
    """The names and settings of one argument."""
    meta, (kind, is_many) = one.metadata, option_kind(one)
    text = meta["help"].replace("%", "%%")
    if isinstance(one.default, int | float | str) and not isinstance(one.default, bool) and one.default != "":
        text += f" (default {one.default})"
    settings: dict[str, Any] = {"help": text}
    if kind is bool:
        settings["action"] = "store_true"
    else:
        settings["metavar"], settings["type"] = meta["metavar"], partial(_value, one)
        if get_origin(kind) is Literal:
            settings["choices"] = get_args(kind)
    is_required = one.default is dataclasses.MISSING
    if meta.get("positional"):
        counts = {(True, True): "+", (True, False): "*", (False, True): None, (False, False): "?"}
        return [one.name], settings | {"nargs": counts[is_many, is_required]}
    if is_many:
        settings |= {"nargs": "+"} if "nargs" in meta else {"action": "append"}
    names = [meta["short"]] if "short" in meta else []
    return [*names, f"--{option_name(one)}"], {**settings, "dest": one.name, "required": is_required, "default": None}


def _value(one: "dataclasses.Field[Any]", word: str) -> Any:
    try:
        return read_word(one, word)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def parsed(parser: Parser, commands: "dict[str, tuple[Parser, type[General]]]", argv: list[str]) -> General | None:
    """Parses a command line.

    Args:
        parser: Parser of all commands.
        commands: Parser and dataclass of each command, by name.
        argv: The words.

    Returns:
        The options as the dataclass of the command; None without a command.

    Raises:
        InputError: For unknown options, also in a file of --config.
    """
    argv = _today(argv)
    own, kind = commands.get(next((word for word in argv if not word.startswith("-")), ""), (parser, General))
    if any(word.partition("=")[0] == "--config" for word in argv):
        _relax(own)
    found, unknown = parser.parse_known_args(argv)
    given = {
        name: value for name, value in vars(found).items() if value is not None and value is not False and value != []
    }
    if unknown:
        names = [name for action in own._actions for name in action.option_strings]
        near = "".join(f"; did you mean {name}?" for name in difflib.get_close_matches(unknown[0], names, 1))
        own.error(f"unrecognized arguments: {' '.join(unknown)}{near}")
    command = given.pop("command", None)
    if command is None:
        return None
    if "config" in given:
        given = {**_read_file(given["config"], command, kind), **given}
    missing = [one for one in options_of(kind) if one.default is dataclasses.MISSING and one.name not in given]
    if missing:
        own.error(f"the following arguments are required: {', '.join(map(option_name, missing))}")
    return kind(**given)


def _relax(parser: Parser) -> None:
    """Makes required options optional, since a file may provide them."""
    for action in parser._actions:
        action.required = False
        if not action.option_strings:
            action.nargs = "*" if action.nargs == "+" else "?"


def _today(argv: list[str]) -> list[str]:
    """Replaces options of 0.2 by their present names, each with a warning."""
    words, rest = [], iter(argv)
    for word in rest:
        old, equals, value = word.partition("=")
        if old not in RENAMED:
            words.append(word)
            continue
        new = renamed(old)
        if new == "PATH":
            new = equals = ""
        elif not new:
            continue
        if new.endswith("="):
            words.append(new + (value if equals else next(rest, "")))
        else:
            words.append(f"{new}{equals}{value}")
    return words


def renamed(old: str) -> str:
    """Present name of an option of 0.2, with a warning.

    Raises:
        InputError: If the option no longer exists.
    """
    new = RENAMED[old]
    if new not in ("", "PATH") and not new.startswith("--"):
        raise InputError(f"{old} is gone: {new}")
    print(f"mmweaver: {old} is now {new.rstrip('=') or 'what happens without it'}", file=sys.stderr)
    return new


def check_mode(asked: General, mode: str, uses: dict[str, str]) -> None:
    """Checks that no options of another mode of a command are given.

    Args:
        asked: The options.
        mode: The mode.
        uses: Names of fields by mode.

    Raises:
        InputError: If an option belongs to another mode.
    """
    own, others = uses[mode].split(), {name for names in uses.values() for name in names.split()}
    for one in options_of(asked):
        if one.name in others and one.name not in own and getattr(asked, one.name) != one.default:
            is_named = not one.metadata.get("positional")
            name = f"--{option_name(one)}" if is_named else one.metadata["metavar"]
            raise InputError(
                f"{name} is for {' or '.join(key for key in uses if one.name in uses[key].split())},"
                f" not for {mode}; leave it out"
            )


# options from a file ------------------------------------------------------------------------------------------------
def _read_file(file: Path, command: str, kind: type[General]) -> dict[str, Any]:
    """The values of a file; InputError if it is not TOML, or has options that the command lacks."""
    from mmweaver.core.safe_files.safe_text import read_toml

    values = read_toml(file)
    meant = values.pop("command", command)
    if meant != command:
        raise InputError(f"{file} is of mmweaver {meant}, not of mmweaver {command}")
    known = {option_name(one): one for one in options_of(kind)}
    found: dict[str, Any] = {}
    for name, value in values.items():
        key = name.replace("_", "-")
        if f"--{key}" in RENAMED:
            if key in IGNORED_IN_FILES or value is False or value == OLD_DEFAULTS.get(key):
                print(f"mmweaver: {file}: {key} has no effect any more", file=sys.stderr)
                continue
            new = renamed(f"--{key}").removeprefix("--")
            if not new:
                continue
            key, _, prefix = new.partition("=")
            if new == "PATH":
                key = next(option_name(one) for one in known.values() if one.metadata.get("positional"))
            elif prefix:
                value = prefix if value is True else f"{prefix}{write_word(value)}"
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
            hint = f"did you mean {near[0]!r}?" if near else f"see mmweaver {command} --help-all"
            raise InputError(f"{file}: mmweaver {command} has no option {name!r}; {hint}")
        one = known[key]
        read = _read_file_value(one, value, file)
        found[one.name] = [*found.get(one.name, ()), *read] if option_kind(one)[1] else read
    return found


def _read_file_value(one: "dataclasses.Field[Any]", value: Any, file: Path) -> Any:
    kind = option_kind(one)[0]

    def beside(each: Any) -> Any:
        """Paths are relative to the file."""
        key, equals, name = str(each).rpartition("=") if kind is Setting else ("", "", str(each))
        is_path = kind is Path or (kind in (Source, Setting) and _is_file(file.parent / name, name))
        return f"{key}{equals}{file.parent / name}" if is_path and not isinstance(each, bool | dict) else each

    try:
        return read_value(one, list(map(beside, value)) if isinstance(value, list) else beside(value))
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def request_toml(asked: General, **instead: Any) -> str:
    """The options of a run as TOML, which `--config` reads.

    Files are written as absolute paths; output paths and display options are omitted.

    Args:
        asked: The options.
        **instead: Values that replace those of some options.
    """
    import tomli_w

    asked = dataclasses.replace(asked, **instead)
    command = type(asked).__module__.rpartition(".")[2]
    written: dict[str, Any] = {"command": command}
    given = given_values(asked)
    has_option = False
    for one in options_of(asked):
        name = option_name(one)
        has_option = has_option or (name == "out" and not one.metadata.get("positional"))
        if name not in given and name in ALWAYS_WRITTEN and getattr(asked, one.name) is not None:
            given[name] = one, [getattr(asked, one.name)]
        if name not in given or not one.metadata.get("is_setting", True):
            continue
        values = [_file_value(one, value) for value in given[name][1]]
        written[name] = values if option_kind(one)[1] else values[0]
    again = f"mmweaver {command} --config {REQUEST_FILE} {'--out DIR' if has_option else 'DIR'}"
    return f"# mmweaver {__version__}; the same again: {again}\n{tomli_w.dumps(written)}"


def _file_value(one: "dataclasses.Field[Any]", value: Any) -> Any:
    """One value as TOML has it."""
    kind = option_kind(one)[0]
    key, equals, name = value.rpartition("=") if kind is Setting else ("", "", value)
    if isinstance(value, Path) or (kind in (Source, Setting) and _is_file(Path(name), name)):
        return f"{key}{equals}{Path(name).absolute()}"
    if hasattr(value, "words"):
        return write_word(value)
    if isinstance(value, tuple) and not any(isinstance(part, tuple | str) for part in value):
        return list(value)
    return value if isinstance(value, bool | int | float) else write_word(value)


def _is_file(path: Path, name: str) -> bool:
    """Whether a `Source` is a file or folder rather than a name."""
    from mmweaver.core.boards import PRESETS

    return name not in PRESETS and name not in ("builtin", "small", "ideal", "typical") and path.exists()


def write_request(folder: Path, asked: General) -> None:
    """Writes the options of a run into its folder, atomically."""
    from mmweaver.core.atomic_files import atomic_file

    with atomic_file(folder / REQUEST_FILE) as partial_file:
        partial_file.write_text(request_toml(asked), encoding="utf-8")
