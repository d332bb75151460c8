"""Options from a TOML file: `--config run.toml`, and the request.toml that a run leaves in its folder."""

import argparse
import difflib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import Parser, landmark, points, radar_pose, source
from mmweaver.core.errors import InputError
from mmweaver.core.version import __version__

REQUEST_FILE = "request.toml"
# options about how a run is shown or carried out or where it goes, not about what it makes
NOT_WRITTEN = {
    "help", "help_all", "out", "overwrite", "json", "quiet", "verbose", "log_level", "config", "workers", "ray_address",
    "dry_run",
}  # fmt: skip
# even where they are the default, which may change
ALWAYS_WRITTEN = {"radar", "frames", "seed", "points", "method", "board"}
NOT_READ = {"help", "help_all", "config"}


def with_config(argv: list[str], commands: dict[str, Parser]) -> list[str]:
    """The command line with the options of its --config put in; what the command line says itself goes first.

    Raises InputError for a file that is no TOML, or has an option that the command does not know.
    """
    file = _config_of(argv)
    if file is None or argv[0] not in commands:
        return argv
    given = argv[1:]
    return [argv[0], *_words(Path(file), argv[0], commands[argv[0]], given), *given]


def request_toml(parser: argparse.ArgumentParser, arguments: argparse.Namespace, **instead: Any) -> str:
    """The options of a run as TOML, which `--config` reads; `instead` replaces the values of some.

    Files are written as absolute paths; `out` and what only concerns printing are left out.
    """
    import tomli_w

    values = {**vars(arguments), **instead}
    command = parser.prog.split()[-1]
    written: dict[str, Any] = {"command": command}
    for action in parser._actions:
        value = values.get(action.dest)
        is_default = value == action.default and action.dest not in ALWAYS_WRITTEN
        if action.dest in NOT_WRITTEN or value is None or is_default:
            continue
        written[_key(action)] = _toml(action, value)
    has_option = any(action.dest == "out" and action.option_strings for action in parser._actions)
    again = f"mmweaver {command} --config {REQUEST_FILE} {'--out DIR' if has_option else 'DIR'}"
    return f"# mmweaver {__version__}; the same again: {again}\n{tomli_w.dumps(written)}"


def write_request(folder: Path, arguments: argparse.Namespace) -> None:
    """Writes the options of a run into its folder, whole or not at all."""
    from mmweaver.core.atomic_files import atomic_file

    with atomic_file(folder / REQUEST_FILE) as partial:
        partial.write_text(request_toml(arguments.parser, arguments), encoding="utf-8")


def _config_of(argv: list[str]) -> str | None:
    for index, word in enumerate(argv):
        if word.startswith("--config="):
            return word.partition("=")[2]
        if word == "--config":
            return argv[index + 1] if index + 1 < len(argv) else None  # argparse says what is missing
    return None


def _words(file: Path, command: str, parser: Parser, given: list[str]) -> list[str]:
    values = _read(file)
    meant = values.pop("command", command)
    if meant != command:
        raise InputError(f"{file} is of mmweaver {meant}, not of mmweaver {command}")
    actions = {_key(action): action for action in parser._actions if action.dest not in NOT_READ}
    words: list[str] = []
    for name, value in values.items():
        key = name.replace("_", "-")
        if key not in actions:
            near = difflib.get_close_matches(key, actions, n=1, cutoff=0.5)
            hint = f"did you mean {near[0]!r}?" if near else f"see mmweaver {command} --help-all"
            raise InputError(f"{file}: mmweaver {command} has no option {name!r}; {hint}")
        if not _is_given(actions[key], given):
            words += _option(actions[key], value, file)
    return words


def _read(file: Path) -> dict[str, Any]:
    from mmweaver.core.safe_files.safe_text import read_toml

    return read_toml(file)


def _key(action: argparse.Action) -> str:
    long = [name for name in action.option_strings if name.startswith("--")]
    return long[0][2:] if long else action.dest.replace("_", "-")


def _is_given(action: argparse.Action, given: Iterable[str]) -> bool:
    if not action.option_strings:
        return action.choices is not None and any(word in action.choices for word in given)
    return any(
        word == option or word.startswith(f"{option}=" if option.startswith("--") else option)
        for option in action.option_strings for word in given
    )  # fmt: skip


def _option(action: argparse.Action, value: Any, file: Path) -> list[str]:
    """One line of the file as words of a command line."""
    name = action.option_strings[-1] if action.option_strings else ""
    if action.nargs == 0:
        if not isinstance(value, bool):
            raise InputError(f"{file}: {_key(action)} is true or false, not {value!r}")
        return [name] if value else []
    many = isinstance(action, argparse._AppendAction) or action.nargs in ("+", "*")
    values = value if many and isinstance(value, list) else [value]
    words = [_word(action, one, file) for one in values]
    if not name:
        return words
    return [name, *words] if action.nargs in ("+", "*") else [f"{name}={word}" for word in words]


def _word(action: argparse.Action, value: Any, file: Path) -> str:
    if isinstance(value, bool | dict):
        raise InputError(f"{file}: {_key(action)} cannot be {value!r}")
    if isinstance(value, list):
        return ",".join(str(one) for one in value)
    beside = file.parent / str(value)  # paths are relative to the file
    if action.type is Path or (action.type is source and _is_file(beside, str(value))):
        return str(beside)
    return str(value)


def _toml(action: argparse.Action, value: Any) -> Any:
    """A value as TOML has it."""
    if isinstance(action, argparse._AppendAction) or action.nargs in ("+", "*"):
        return [_toml_single(action, one) for one in value]
    return _toml_single(action, value)


def _toml_single(action: argparse.Action, value: Any) -> Any:
    if isinstance(value, Path):
        return str(value.absolute())
    if action.type is landmark:
        kind, (x, y) = value
        return f"{kind}={x},{y}"
    if action.type is radar_pose:
        return value.words
    if action.type is points:
        return " ".join(f"{x},{y}" for x, y in value)
    if isinstance(value, tuple):
        return list(value)
    if action.type is source and _is_file(Path(value), value):
        return str(Path(value).absolute())
    return value


def _is_file(path: Path, name: str) -> bool:
    """Whether a `source` is a file or folder and no name."""
    from mmweaver.core.presets import PRESETS

    return name not in PRESETS and name not in ("builtin", "small", "ideal", "typical") and path.exists()
