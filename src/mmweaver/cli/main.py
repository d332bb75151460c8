"""The mmweaver command: one line for what went wrong, status 2 for bad input, and never a traceback for it."""

import gc
import os
import sys
from collections.abc import Sequence

from mmweaver.cli import (
    completion,
    compress,
    dataset,
    decompress,
    evaluate,
    generate,
    info,
    motion,
    motions,
    process,
    radar,
    rooms,
    train,
)
from mmweaver.cli.arguments import Parser, add_general_options, glued
from mmweaver.cli.config_file import with_config
from mmweaver.cli.log import set_up_log
from mmweaver.core.errors import InputError
from mmweaver.core.version import __version__

DESCRIPTION = "A photo of a room and a sentence in, the I/Q signal of an FMCW MIMO radar out."
EXAMPLES = """examples:
  mmweaver generate --demo
  mmweaver generate --rgb rgb.png --depth depth.png --camera camera.json \\
      --text "a person walks towards the radar, then waves with the left hand" --out walk/
  mmweaver process adc_data.bin --radar radar.json --iq-order iq --tx-order 0,2,1 --out capture/
  mmweaver radar awr1843
  mmweaver compress walk/radar.npz -o walk.mmw --bytes 10000
"""
BAD_INPUT, INTERRUPTED, READER_GONE = 2, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command and gives its exit status: 0, 2 for bad input, 130 when interrupted, 141 for a closed pipe."""
    if argv is None:
        gc.set_threshold(100_000, 50, 100)  # of 0.7 million objects few are garbage: a tenth less CPU time
    try:
        status = _run(sys.argv[1:] if argv is None else list(argv))
        sys.stdout.flush()
        return status
    except InputError as error:
        return _fail(str(error))
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written")
        return INTERRUPTED
    except BrokenPipeError:
        _close_stdout()
        return READER_GONE
    except MemoryError:
        return _fail("out of memory; ask for fewer --frames or close other programs")
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _fail(f"{place}{error.strerror or error}")


def build_parser() -> Parser:
    """The whole command line."""
    return _parser_and_commands()[0]


def _parser_and_commands() -> tuple[Parser, dict[str, Parser]]:
    parser = Parser(prog="mmweaver", description=DESCRIPTION, epilog=EXAMPLES)
    parser.add_argument("--version", action="version", version=f"mmweaver {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    modules_in_order = (
        generate, process, radar, compress, decompress, info, rooms, motions, motion, evaluate, dataset, train,
        completion,
    )  # fmt: skip
    for module in modules_in_order:
        command = module.add_command(commands)
        add_general_options(command)
        command.set_defaults(parser=command, whole_parser=parser)
    return parser, commands.choices


def _run(argv: list[str]) -> int:
    parser, commands = _parser_and_commands()
    arguments = parser.parse_args(with_config(glued(argv), commands))
    if arguments.command is None:
        parser.print_help()
        return BAD_INPUT
    set_up_log(arguments.log_level, verbose=arguments.verbose)
    return arguments.run(arguments)


def _fail(message: str) -> int:
    print(f"mmweaver: error: {' '.join(message.split())}", file=sys.stderr)
    return BAD_INPUT


def _close_stdout() -> None:
    """Nobody reads on: what is still buffered goes nowhere, quietly."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, sys.stdout.fileno())
    except (OSError, ValueError):
        sys.stdout = None  # type: ignore[assignment]
    finally:
        os.close(nowhere)
