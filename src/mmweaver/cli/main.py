"""The mmweaver command: one line per error, status 2 for bad input, and no traceback."""

import gc
import json
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from shutil import get_terminal_size
from textwrap import fill
from typing import TYPE_CHECKING

from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError, one_line

if TYPE_CHECKING:
    from mmweaver.cli.arguments import General, Parser

# in the order of the help; each is a module with Options, run and EXAMPLES, imported on demand
COMMANDS = {
    "generate": "generate the signal of a person in the room of a photo",
    "sample": "write files to try the other commands with, or sample a field",
    "studio": "make and watch radar data in the browser",
    "view": "play a result folder in the browser",
    "plot": "draw the features of a signal, as recognisers take them",
    "export": "write results in the formats of other tools",
    "process": "process a recording: range, Doppler, angle, CFAR",
    "compare": "compare two signals, recorded or simulated",
    "calibrate": "find the errors of your board in its recordings",
    "points": "read a point cloud of a board or a data set",
    "pose": "estimate the poses of a person from a radar's points",
    "radar": "print a radar's chirp, resolutions and limits",
    "fit": "fit a field to a signal, a network or scatterers, that can be sampled anywhere",
    "compress": "store a recording in few bytes",
    "decompress": "read a .mmw file back into radar.npz",
    "info": "print what a .mmw or .mmwl file holds",
    "rooms": "generate furnished rooms with photo, depth and ground truth",
    "motions": "list what a person can do, with example sentences",
    "motion": "try a sentence: how it is read, and the moving skeleton on an empty floor",
    "recognise": "train a recogniser of activities on generated data, score it, run it",
    "evaluate": "score what was trained on generated data on real recordings",
    "dataset": "generate a data set of rooms, motions and radar signals",
    "train": "train the network on a data set",
    "verify": "check that nothing is damaged or missing",
    "completion": "print a shell's completion script",
}
DESCRIPTION = "A photo of a room and a sentence in, the I/Q signal of an FMCW MIMO radar out."
EXAMPLES = """examples:
  mmweaver generate --demo
  mmweaver sample room/ && cd room/
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json \\
      --text "a person walks towards the radar, then waves with the left hand" --out walk/
  mmweaver process adc_data.bin --radar radar.json --iq-order iq --tx-order 0,2,1 --out capture/
  mmweaver radar awr1843
  mmweaver compress walk/radar.npz -o walk.mmw --bytes 10000
"""
BAD_INPUT, INTERRUPTED, READER_GONE = 2, 130, 141
AGAIN_S = 0.05  # delay before a deferred interruption is raised again


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command.

    Args:
        argv: The words; by default those of the process.

    Returns:
        Exit status: 0, 2 for bad input, 130 when interrupted, 141 for a closed pipe.
    """
    if argv is not None:
        return _status(list(argv))
    try:
        gc.set_threshold(400_000, 20, 100)  # few of 0.7 million objects are garbage: saves a tenth of the CPU time
        _stop_cleanly()
        return _status(sys.argv[1:])
    except KeyboardInterrupt:  # before the command began, or again while the first one was reported
        return INTERRUPTED
    finally:
        gc.freeze()  # the process ends: saves a last garbage collection of half a second


def _status(argv: list[str]) -> int:
    from mmweaver.cli.terminal import safe_printing

    with safe_printing():
        return _printed_status(argv)


def _printed_status(argv: list[str]) -> int:
    try:
        status = _run(argv)
        sys.stdout.flush()
        return status
    except InputError as error:
        if "--json" in (sys.argv[1:] if argv is None else argv):
            print(
                json.dumps({"error": str(error), "ways_on": getattr(error, "recovery_options", {})}, ensure_ascii=False)
            )
        return _fail(str(error))
    except KeyboardInterrupt as stopped:
        _fail(f"interrupted; {str(stopped) or _kept()}")
        return INTERRUPTED
    except BrokenPipeError:
        _close_stdout()
        return READER_GONE
    except MemoryError:
        return _fail("out of memory; ask for fewer --frames or close other programs")
    except UnicodeEncodeError as error:
        return _fail(f"{error.object[max(error.start - 60, 0) : error.end + 20]!r} is no text; rename it")
    except OSError as error:
        return _fail(_failed(error))


def build_parser() -> "Parser":
    """The parser of the whole command line."""
    return parser_of(*COMMANDS, rare=True)[0]


def parser_of(*names: str, rare: bool = False) -> "tuple[Parser, dict[str, tuple[Parser, type[General]]]]":
    """The parser with the options of some commands, and each command's own parser and options.

    Args:
        *names: Names of the commands.
        rare: Whether the help shows rare options.
    """
    from mmweaver.cli.arguments import Parser, add_options

    parser = Parser(prog="mmweaver", description=DESCRIPTION, epilog=EXAMPLES)
    parser.add_argument("--version", action="version", version=f"mmweaver {__version__}")
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    commands = {}
    for name, text in COMMANDS.items():
        if name not in names:
            subparsers.add_parser(name, help=text)
            continue
        module = import_module(f"mmweaver.cli.{name}")
        command = subparsers.add_parser(
            name,
            help=text,
            epilog=module.EXAMPLES,
            usage=getattr(module, "USAGE", None),
            description=fill(" ".join((module.Options.__doc__ or "").split()), get_terminal_size().columns - 2),
        )
        add_options(command, module.Options, rare=rare)
        commands[name] = command, module.Options
    return parser, commands


def _run(argv: list[str]) -> int:
    from mmweaver.cli.arguments import HELP_ALL, parsed
    from mmweaver.cli.progress import set_up_log
    from mmweaver.core.atomic_files import forget_written
    from mmweaver.core.output_checks import forget_outputs

    _check_words(argv)
    parser, commands = parser_of(*argv[:1], rare=HELP_ALL in argv)
    argv = ["--help" if word == HELP_ALL else word for word in argv]
    options = parsed(parser, commands, argv)
    if options is None:
        parser.print_help()
        return BAD_INPUT
    _check_names(options)
    forget_written()
    forget_outputs()
    set_up_log(verbose=options.verbose)
    return import_module(type(options).__module__).run(options)


def _check_words(argv: list[str]) -> None:
    """Rejects words that are no text, and a working directory that is gone, before anything is computed."""
    for word in argv:
        if not _is_text(word):
            raise InputError(f"{word!r} is no UTF-8 text; rename the file, or type the word anew")
    from pathlib import Path

    try:
        place = str(Path.cwd())
    except OSError:
        raise InputError("the working directory was removed; change into another one") from None
    if not _is_text(place):
        raise InputError(f"the name of the working directory, {place!r}, is no UTF-8 text; rename it")


def _is_text(word: str) -> bool:
    try:
        word.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _check_names(options: "General") -> None:
    """Rejects names of files with control characters, which would go to the terminal and into files."""
    from pathlib import Path

    from mmweaver.cli.terminal import printable

    for value in vars(options).values():
        for name in value if isinstance(value, list | tuple) else [value]:
            if isinstance(name, Path) and printable(name) != str(name):
                raise InputError(f"{str(name)!r} contains control characters; choose or rename it without them")


def _failed(error: OSError) -> str:
    """What the operating system refused, without names of unfinished files."""
    from pathlib import Path

    from mmweaver.core.output_checks import ADVICE
    from mmweaver.core.staging import STAGED

    name = str(error.filename or "")
    if any(STAGED.fullmatch(part) for part in Path(name).parts):
        name = ""
    place = f"{name}: " if name else ""
    advice = ADVICE.get(error.errno or 0)
    return f"{place}{error.strerror or error}{f'; {advice}' if advice else ''}"


def _fail(message: str) -> int:
    print(f"mmweaver: error: {one_line(message)}", file=sys.stderr)
    return BAD_INPUT


def _kept() -> str:
    """Description of what an interrupted command has written completely."""
    from mmweaver.core.atomic_files import written

    names = [str(path) for path in written() if path.exists()]
    if not names:
        return "nothing was written"
    return f"finished and kept: {', '.join(names[:3])}{f' and {len(names) - 3} more' if len(names) > 3 else ''}"


def _stop_cleanly() -> None:
    """Makes termination and a closed terminal interrupt like Ctrl-C, so that nothing is left behind."""
    import signal

    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _interrupt)


def _interrupt(*_: object) -> None:
    """Raises KeyboardInterrupt, deferred while PyTorch is being imported, which would abort the process."""
    torch = sys.modules.get("torch")
    if torch is not None and getattr(torch.__spec__, "_initializing", False):
        import _thread
        import threading

        threading.Timer(AGAIN_S, _thread.interrupt_main).start()
        return
    raise KeyboardInterrupt


def _close_stdout() -> None:
    """Discards buffered output quietly, since the reader has closed the pipe."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, sys.stdout.fileno())
    except (OSError, ValueError):
        sys.stdout = None  # type: ignore[assignment]
    finally:
        os.close(nowhere)
