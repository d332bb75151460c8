"""How words of the command line become values; a bad one is an InputError like any other."""

import argparse
from typing import Any, NoReturn

from mmweaver.core.errors import InputError

SIGNED = ("--at", "--heading", "--motion-up")  # options whose values may begin with a minus
Options = argparse.ArgumentParser | argparse._ArgumentGroup


class Parser(argparse.ArgumentParser):
    """argparse that raises InputError rather than print its usage and exit."""

    def __init__(self, **options: Any):
        options.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        super().__init__(**options, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")


def glued(argv: list[str]) -> list[str]:
    """Joins `--at -0.5,2` into one word: argparse would take the minus for an option (so with --heading, --motion-up).

    >>> glued(["generate", "--at", "-0.5,2", "--frames", "5"])
    ['generate', '--at=-0.5,2', '--frames', '5']
    """
    words: list[str] = []
    for word in argv:
        if words and words[-1] in SIGNED and word[:1] == "-" and word[1:2] in "0123456789.xyz":
            words[-1] = f"{words[-1]}={word}"
        else:
            words.append(word)
    return words


def place(word: str) -> tuple[float, float]:
    """'0.5,2' -> (0.5, 2.0), metres."""
    try:
        x, y = (float(part) for part in word.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no place; write x,y in metres, for example 0.5,2") from None
    return x, y


def told(word: str) -> tuple[str, tuple[float, float]]:
    """'door=0.9,2.8' -> ("door", (0.9, 2.8))."""
    kind, equals, where = word.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{word!r} is no landmark; write KIND=X,Y in metres, for example door=0.9,2.8")
    return kind.strip().lower(), place(where)


def turns(word: str) -> tuple[int, ...]:
    """'0,2,1' -> (0, 2, 1)."""
    try:
        return tuple(int(part) for part in word.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{word!r} is no order of transmitters; write their numbers, for example 0,2,1"
        ) from None


def whole(word: str) -> int:
    """A whole number, with a message that says so."""
    try:
        return int(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no whole number") from None


def number(word: str) -> float:
    """A number, with a message that says so."""
    try:
        return float(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no number") from None


def add_output_options(parser: Options) -> None:
    """The options that every writing verb shares."""
    parser.add_argument("--overwrite", action="store_true", help="replace files of an earlier run in --out")
    parser.add_argument("--json", action="store_true", help="print a summary for machines on stdout")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")


def add_layout_options(parser: Options) -> None:
    """The options that say how a DCA1000 .bin is laid out."""
    parser.add_argument("--iq-order", choices=("iq", "qi"), help="I or Q first in the .bin (default iq)")
    parser.add_argument(
        "--tx-order", type=turns, metavar="N,N,N", help="transmitters in their turns (default: the radar's)"
    )


def add_points_option(parser: Options) -> None:
    """The option that chooses the point cloud."""
    parser.add_argument(
        "--points",
        choices=("cfar", "firmware"),
        default="cfar",
        help="point cloud: cfar, ours (default), or firmware, as TI's out-of-box demo would report it with the"
        " cfarCfg, peakGrouping, clutterRemoval and multiObjBeamForming of the radar's .cfg",
    )
