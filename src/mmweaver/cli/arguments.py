"""The command line's parser: words become values, rare options stay out of the short help, errors are one line."""

import argparse
import difflib
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NoReturn

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.core.radar_pose import RadarPose

# options whose values may begin with a minus
SIGNED = ("--at", "--path", "--heading", "--motion-up", "--radar-pose", "--mesh-eye", "--mesh-look")
LOG_LEVELS = ("debug", "info", "warning", "error")
Options = argparse.ArgumentParser | argparse._ArgumentGroup


class Rare(str):
    """The help of an option that only --help-all shows."""


class Parser(argparse.ArgumentParser):
    """argparse that raises InputError instead of exiting, and has a short and a full help."""

    def __init__(self, **options: Any):
        options.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        super().__init__(**options, allow_abbrev=False)
        self.register("action", "help_all", _HelpAllAction)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """As argparse, with the nearest choice instead of all where one is near."""
        near = difflib.get_close_matches(str(value), map(str, action.choices or ()), 1)
        if near and value not in (action.choices or ()):
            raise argparse.ArgumentError(action, f"{value!r} is unknown; did you mean {near[0]}?")
        super()._check_value(action, value)

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As argparse, but what no command knows is said by that command, with the nearest option."""
        found, unknown = self.parse_known_args(args, namespace)
        if unknown:
            command = getattr(found, "parser", self)
            options = [name for action in command._actions for name in action.option_strings]
            near = difflib.get_close_matches(unknown[0], options, 1)
            command.error(
                f"unrecognized arguments: {' '.join(unknown)}" + "".join(f"; did you mean {one}?" for one in near)
            )
        return found

    def format_help(self) -> str:
        """The help without rare options, and how to see these."""
        rare = [action for action in self._actions if isinstance(action.help, Rare)]
        texts = [action.help for action in rare]
        for action in rare:
            action.help = argparse.SUPPRESS
        try:
            shown = super().format_help()
        finally:
            for action, text in zip(rare, texts, strict=True):
                action.help = text
        options = "option" if len(rare) == 1 else "options"
        return f"{shown}\n{len(rare)} more {options}: {self.prog} --help-all\n" if rare else shown

    def format_help_all(self) -> str:
        """The help with every option."""
        return super().format_help()


class _HelpAllAction(argparse.Action):
    """Prints the full help and exits."""

    def __init__(self, option_strings: list[str], dest: str, **options: Any):
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, default=argparse.SUPPRESS, help=options["help"])

    def __call__(self, parser: argparse.ArgumentParser, *_: Any, **__: Any) -> None:
        if isinstance(parser, Parser):
            print(parser.format_help_all(), end="")
        parser.exit()


def glued(argv: list[str]) -> list[str]:
    """Joins `--at -0.5,2` into one word, because argparse would take the minus for an option.

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


# types of values ----------------------------------------------------------------------------------------------------
def place(word: str) -> tuple[float, float]:
    """'0.5,2' -> (0.5, 2.0), metres."""
    try:
        x, y = (number(part) for part in word.split(","))
    except (ValueError, argparse.ArgumentTypeError):
        raise argparse.ArgumentTypeError(f"{word!r} is no place; write x,y in metres, for example 0.5,2") from None
    return x, y


def triple(word: str) -> tuple[float, float, float]:
    """'0.5,2,1' -> (0.5, 2.0, 1.0)."""
    try:
        x, y, z = (number(part) for part in word.split(","))
    except (ValueError, argparse.ArgumentTypeError):
        raise argparse.ArgumentTypeError(f"{word!r} is no place; write x,y,z, for example 0.5,2,1.2") from None
    return x, y, z


def points(words: str) -> tuple[tuple[float, float], ...]:
    """'0,3 0.5,1' -> ((0.0, 3.0), (0.5, 1.0)), metres."""
    return tuple(place(word) for word in words.split())


def landmark(word: str) -> tuple[str, tuple[float, float]]:
    """'door=0.9,2.8' -> ("door", (0.9, 2.8))."""
    kind, equals, where = word.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{word!r} is no landmark; write KIND=X,Y in metres, for example door=0.9,2.8")
    return kind.strip().lower(), place(where)


def radar_pose(word: str) -> "RadarPose":
    """'0.5,0,0.2,-30,10' -> a radar's place in metres, its yaw and pitch in degrees."""
    from mmweaver.core.radar_pose import RadarPose

    try:
        return RadarPose.of_words(word)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def transmitters(word: str) -> tuple[int, ...]:
    """'0,2,1' -> (0, 2, 1)."""
    try:
        return tuple(int(part) for part in word.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{word!r} is no order of transmitters; write their numbers, for example 0,2,1"
        ) from None


def span_m(word: str) -> tuple[float, float]:
    """'0.3,8' -> (0.3, 8.0), metres."""
    try:
        near, far = (float(part) for part in word.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no range; write NEAR,FAR in metres, for example 0.3,8") from None
    return near, far


def span_bins(word: str) -> tuple[int, int]:
    """'0,127' -> (0, 127)."""
    try:
        first, last = (int(part) for part in word.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} names no bins; write FIRST,LAST, for example 0,127") from None
    return first, last


def whole(word: str) -> int:
    """A whole number, with a message that says so."""
    try:
        value = int(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no whole number") from None
    if abs(value) >= 2**63:
        raise argparse.ArgumentTypeError(f"{word!r} is too large; the largest is {2**63 - 1}")
    return value


def number(word: str) -> float:
    """A number, with a message that says so."""
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{word!r} is no number")
    return value


def source(word: str) -> str:
    """A file or folder, or a name that is known elsewhere: a preset, a model that comes along, a name on the Hub."""
    return word


# options that several commands share --------------------------------------------------------------------------------
def help_of(is_rare: bool) -> Callable[[str], str]:
    """Marks a help text as rare, or leaves it."""
    return Rare if is_rare else str


def add_output_options(parser: Options) -> None:
    """The options of every command that writes a folder of results."""
    parser.add_argument("--overwrite", action="store_true", help="replace files of an earlier run in --out")
    parser.add_argument("--json", action="store_true", help="print a machine-readable summary on stdout")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")


def add_general_options(parser: argparse.ArgumentParser) -> None:
    """The options of every command."""
    general = parser.add_argument_group("general")
    general.add_argument("-v", "--verbose", action="store_true", help="print every assumption, and log each stage")
    general.add_argument(
        "--log-level", choices=LOG_LEVELS, help=Rare("what is logged on stderr (default warning; with -v info)")
    )
    general.add_argument(
        "--config", metavar="TOML", help="read options from a file, such as the request.toml of an earlier run; options"
        " of the command line go first",
    )  # fmt: skip
    general.add_argument("--help-all", action="help_all", help="show this help with all options and exit")


def add_layout_options(parser: Options, *, rare: bool = False) -> None:
    """The options that say how a DCA1000 .bin is laid out."""
    shown = help_of(rare)
    parser.add_argument(
        "--iq-order", choices=("iq", "qi", "interleaved"),
        help=shown(
            "order of I and Q in the .bin: I I Q Q, Q Q I I or I Q I Q (default: as the .cfg or mmWave Studio file"
            " says, else iq)"
        ),
    )  # fmt: skip
    parser.add_argument(
        "--tx-order", type=transmitters, metavar="N,N,N",
        help=shown("order in which the transmitters fire (default: the radar's)"),
    )  # fmt: skip


def add_sample_options(parser: Options, *, brought: str = "") -> None:
    """The options that say how raw samples are to be read; `brought`: when they need no --radar."""
    known = f" ({brought})" if brought else ""
    parser.add_argument(
        "--radar", type=source, metavar="NAME|FILE", help=f"preset, TI .cfg or radar.json{known}"
    )  # fmt: skip
    parser.add_argument("--axes", metavar="NAMES", help="axes of a .npy in their order: frame,loop,tx,rx,sample")
    parser.add_argument(
        "--layout", metavar="NAME",
        help="whose .npy it is: hupr (a frame or a folder of them), mmmesh, rf_genesis, cubelearn",
    )  # fmt: skip
    add_layout_options(parser)


def add_range_options(
    parser: Options, *, rare: bool = False,
    what: str = "to keep (default: a preset's own window; all of a .cfg, up to 4 MiB a frame)",
) -> None:  # fmt: skip
    """The options that choose which ranges a radar keeps, or what is looked at."""
    shown = help_of(rare)
    parser.add_argument(
        "--range", type=span_m, metavar="NEAR,FAR", dest="range_m",
        help=shown(f"metres {what}"),
    )  # fmt: skip
    parser.add_argument("--range-bins", type=span_bins, metavar="FIRST,LAST", help=shown("the same in range bins"))


def add_board_options(parser: Options, *, rare: bool = False) -> None:
    """The options for what a radar's file leaves open; `radar_of` adds them to its name."""
    shown = help_of(rare)
    parser.add_argument(
        "--subframe", type=whole, metavar="N", help=shown("which sub-frame of a .cfg or mmWave Studio file, from 0 on")
    )
    parser.add_argument(
        "--antennas", type=source, metavar="NAME|FILE",
        help=shown("the board's antennas: isk, boost, boost1642, aop, ods, evm2944, or a JSON with tx and rx in half"
                   " wavelengths (default: what the .cfg says)"),
    )  # fmt: skip
    parser.add_argument(
        "--lanes", type=whole, metavar="2|4",
        help=shown("lanes of a DCA1000's .bin: 2 (xWR16xx, 18xx, 68xx) or 4 (xWR12xx, 14xx; default: the radar's)"),
    )  # fmt: skip


def radar_of(arguments: argparse.Namespace, default: str | None = None, *, option: str = "radar") -> str | None:
    """--radar with --subframe, --antennas and --lanes behind it, as `load_radar` reads them. Raises InputError."""
    from mmweaver.formats.radar_options import joined_radar

    name = getattr(arguments, option) or default
    given = {"sub_frame": arguments.subframe, "antennas": arguments.antennas, "lanes": arguments.lanes}
    if name is None:
        if any(value is not None for value in given.values()):
            raise InputError("--subframe, --antennas and --lanes belong to a radar; give --radar, too")
        return None
    return joined_radar(name, **given)


def add_board_option(parser: Options) -> None:
    """The option that chooses the board whose errors a signal has."""
    parser.add_argument(
        "--board", type=source, metavar="typical|ideal|FILE",
        help="the board whose errors the signal has: typical, sampled by the seed from the spread of recorded boards"
        " (default; typical:N is one of them), ideal, or a board.json of mmweaver calibrate; with --background the"
        " default is the recording's own",
    )  # fmt: skip


def add_points_option(parser: Options) -> None:
    """The option that chooses the point cloud."""
    parser.add_argument(
        "--points", default="cfar", metavar="cfar|firmware",
        help="point cloud: cfar, ours (default), or firmware, as TI's out-of-box demo would report it with the"
        " cfarCfg, peakGrouping, clutterRemoval and multiObjBeamForming of the radar's .cfg",
    )  # fmt: skip
