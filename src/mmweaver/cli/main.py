"""The mmweaver command: one line for what went wrong, status 2 for bad input, and never a traceback for it."""

import gc
import json
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

from mmweaver.core.errors import InputError
from mmweaver.core.version import __version__

if TYPE_CHECKING:
    from mmweaver.cli.arguments import Parser

# in the order of the help; their modules are imported where an interruption is handled already
COMMANDS = (
    "generate", "sample", "studio", "view", "plot", "export", "process", "compare", "calibrate", "points", "pose",
    "radar", "compress", "decompress", "info", "rooms", "motions", "motion", "recognise", "evaluate", "dataset",
    "train", "verify", "completion",
)  # fmt: skip
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
AGAIN_S = 0.05  # until an interruption that came at a bad time is tried again


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command and gives its exit status: 0, 2 for bad input, 130 when interrupted, 141 for a closed pipe."""
    if argv is not None:
        return _status(list(argv))
    try:
        gc.set_threshold(400_000, 20, 100)  # of 0.7 million objects few are garbage: a tenth less CPU time
        _stop_cleanly()
        return _status(sys.argv[1:])
    except KeyboardInterrupt:  # before the command began, or again while the first was reported
        return INTERRUPTED
    finally:
        gc.freeze()  # the process ends: nobody need search those objects for garbage, which takes half a second


def _status(argv: list[str]) -> int:
    try:
        status = _run(argv)
        sys.stdout.flush()
        return status
    except InputError as error:
        if "--json" in (sys.argv[1:] if argv is None else argv):
            print(json.dumps({"error": str(error), "ways_on": getattr(error, "ways_on", {})}, ensure_ascii=False))
        return _fail(str(error))
    except KeyboardInterrupt as stopped:
        _fail(f"interrupted; {str(stopped) or _kept()}")
        return INTERRUPTED
    except BrokenPipeError:
        _close_stdout()
        return READER_GONE
    except MemoryError:
        return _fail("out of memory; ask for fewer --frames or close other programs")
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _fail(f"{place}{error.strerror or error}")


def build_parser() -> "Parser":
    """The whole command line."""
    return _parser_and_commands()[0]


def _parser_and_commands() -> "tuple[Parser, dict[str, Parser]]":
    from mmweaver.cli.arguments import Parser, add_general_options

    parser = Parser(prog="mmweaver", description=DESCRIPTION, epilog=EXAMPLES)
    parser.add_argument("--version", action="version", version=f"mmweaver {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    for name in COMMANDS:
        command = import_module(f"mmweaver.cli.{name}").add_command(commands)
        add_general_options(command)
        command.set_defaults(parser=command, whole_parser=parser)
    return parser, commands.choices


def _run(argv: list[str]) -> int:
    from mmweaver.cli.arguments import glued
    from mmweaver.cli.config_file import with_config
    from mmweaver.cli.log import set_up_log
    from mmweaver.core.atomic_files import forget_written

    parser, commands = _parser_and_commands()
    arguments = parser.parse_args(with_config(glued(argv), commands))
    if arguments.command is None:
        parser.print_help()
        return BAD_INPUT
    forget_written()
    set_up_log(arguments.log_level, verbose=arguments.verbose)
    return arguments.run(arguments)


def _fail(message: str) -> int:
    print(f"mmweaver: error: {' '.join(message.split())}", file=sys.stderr)
    return BAD_INPUT


def _kept() -> str:
    """What an interrupted command has written completely."""
    from mmweaver.core.atomic_files import written

    names = [str(path) for path in written()]
    if not names:
        return "nothing was written"
    return f"finished and kept: {', '.join(names[:3])}{f' and {len(names) - 3} more' if len(names) > 3 else ''}"


def _stop_cleanly() -> None:
    """An orderly end of the process, and a closed terminal, interrupt as Ctrl-C does, so that nothing is left over."""
    import signal

    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _interrupt)


def _interrupt(*_: object) -> None:
    """Raises KeyboardInterrupt; while PyTorch starts, which would abort the process, as soon as it has started."""
    torch = sys.modules.get("torch")
    if torch is not None and getattr(torch.__spec__, "_initializing", False):
        import _thread
        import threading

        threading.Timer(AGAIN_S, _thread.interrupt_main).start()
        return
    raise KeyboardInterrupt


def _close_stdout() -> None:
    """Nobody reads on: what is still buffered goes nowhere, quietly."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, sys.stdout.fileno())
    except (OSError, ValueError):
        sys.stdout = None  # type: ignore[assignment]
    finally:
        os.close(nowhere)
