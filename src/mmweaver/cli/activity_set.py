"""mmweaver dataset --activities: a labelled set in one's own rooms."""

import argparse
import json
import shlex
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import Options, number, radar_of, whole
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.activity_sets.build_set import SetBuilder

NEEDS_ACTIVITIES = ("room", "rgb", "depth", "camera", "each", "seconds", "subjects", "split_by", "method", "iq")
OF_ROOM_SETS = {
    "rooms": None,
    "layouts": 10,
    "sequences": 120,
    "frames": 20,
    "geometry_only": False,
    "workers": 1,
    "ray_address": None,
    "repair": False,
}  # options of other data sets, with their defaults


def add_activity_options(group: Options) -> None:
    """Declares the options; all need --activities."""
    group.add_argument(
        "--activities", type=Path, metavar="TOML",
        help='a file with a table [activities] of lines such as: waving = ["a person waves with the left hand"]',
    )  # fmt: skip
    group.add_argument(
        "--room", type=Path, action="append", metavar="DIR",
        help="a folder with rgb.png, depth.png and camera.json (mmweaver rooms makes such folders), views.json, a scan,"
        " a capture folder, a ROS bag or a mesh; once more for each further room",
    )  # fmt: skip
    group.add_argument("--rgb", type=Path, metavar="PNG", help="instead of --room: colour picture of the room")
    group.add_argument("--depth", type=Path, metavar="FILE", help="its depth")
    group.add_argument("--camera", type=Path, metavar="JSON", help="its camera")
    group.add_argument(
        "--from-results", type=Path, metavar="DIR",
        help="instead of making sequences: the result folders in DIR, as mmweaver generate --texts writes them, become"
        " one set; without --activities each sentence is a label",
    )  # fmt: skip
    group.add_argument("--each", type=whole, metavar="N", help="sequences of each label (default 20)")
    group.add_argument("--seconds", type=number, metavar="S", help="length of every sequence (default 3)")
    group.add_argument("--subjects", type=whole, metavar="N", help="different people (default 10)")
    group.add_argument(
        "--split-by",
        choices=("subject", "place", "room", "sentence"),
        help="what is held out for tests (default subject)",
    )
    group.add_argument("--method", help="weaver, the network (default), or physics")
    group.add_argument(
        "--iq", choices=("float16", "float32", "none"),
        help="how signals are stored (default float16, an error below 0.05 %%); none: joints, points and what signals"
        " are made from when they are read, in a thirtieth of the space",
    )  # fmt: skip


def is_activity_set_asked(arguments: argparse.Namespace) -> bool:
    """Whether --activities or --from-results is given. Raises InputError for one of their options without them."""
    given = [name for name in NEEDS_ACTIVITIES if getattr(arguments, name) is not None]
    if arguments.activities is not None or arguments.from_results is not None:
        for name, default in OF_ROOM_SETS.items():
            if getattr(arguments, name) != default:
                raise InputError(
                    f"--{name.replace('_', '-')} is for data sets of rooms; leave it out of a labelled set"
                )
        return True
    if given:
        raise InputError(f"--{given[0].replace('_', '-')} is for labelled sets; give --activities, too")
    return False


def run_activity_set(arguments: argparse.Namespace) -> int:
    """Makes what is missing of the set and prints the verdict of its leak report. Raises InputError."""
    if arguments.from_results is not None:
        return _run_from_results(arguments)
    from mmweaver.activity_sets.build_set import SetBuilder, SetOptions, read_activities
    from mmweaver.activity_sets.confounders import verdict_of
    from mmweaver.core.range_window import chosen_range
    from mmweaver.core.safe_files.safe_text import read_text
    from mmweaver.formats.radar_file import load_radar
    from mmweaver.generate import Weaver

    activities = read_activities(arguments.activities)
    given = {name: getattr(arguments, name) for name in ("each", "seconds", "subjects", "split_by", "iq")}
    options = SetOptions(
        seed=arguments.seed, board=arguments.board or "typical",
        **{name: value for name, value in given.items() if value is not None},
    )  # fmt: skip
    config = chosen_range(load_radar(radar_of(arguments) or "awr1843"), arguments.range_m, arguments.range_bins)
    weaver = Weaver(method=arguments.method or "auto", radar=config)
    builder = SetBuilder(
        arguments.out, activities, _rooms(arguments, weaver), weaver, options, command=_command(),
        activities_text=read_text(arguments.activities),
    )  # fmt: skip
    if arguments.dry_run:
        cost = builder.cost()
        print(json.dumps(asdict(cost)) if arguments.json else cost.summary(1))
        return 0
    report = make_with_bar(builder, quiet=arguments.quiet)
    if arguments.json:
        print(json.dumps({"out": str(arguments.out), "leaks": report}))
    elif not arguments.quiet:
        print(f"{len(activities)} labels x {options.each} sequences in {arguments.out}; {verdict_of(report)}")
    return 0


def _run_from_results(arguments: argparse.Namespace) -> int:
    """Result folders as one set."""
    from mmweaver.activity_sets.build_set import read_activities
    from mmweaver.activity_sets.confounders import verdict_of
    from mmweaver.activity_sets.from_results import set_of_results
    from mmweaver.core.output_checks import check_output_folder

    given = [name for name in NEEDS_ACTIVITIES if name != "split_by" and getattr(arguments, name) is not None]
    if given:
        raise InputError(f"--from-results takes sequences as they are; leave out --{given[0].replace('_', '-')}")
    check_output_folder(arguments.out, overwrite=False, inputs=[arguments.from_results])
    activities = None if arguments.activities is None else read_activities(arguments.activities)
    report = set_of_results(
        arguments.from_results, arguments.out, activities=activities, split_by=arguments.split_by,
        seed=arguments.seed, command=_command(),
    )  # fmt: skip
    if arguments.json:
        print(json.dumps({"out": str(arguments.out), "leaks": report}))
    elif not arguments.quiet:
        print(f"{report['of']['order']['sequences']} sequences in {arguments.out}; {verdict_of(report)}")
    return 0


def make_with_bar(builder: "SetBuilder", *, quiet: bool) -> dict[str, Any]:
    """The leak report of the set, once what was missing of it is made; a bar shows how far it is."""
    from tqdm import tqdm

    from mmweaver.datasets.dataset_cost import check_for_space

    if (words := builder.ignored_descriptions) and not quiet:
        described = ", ".join(repr(one) for one in words)
        note = f"note: sentences describe different people ({described}); whoever is drawn does all activities"
        print(note, file=sys.stderr)
    builder.check_folder()
    if not builder.is_made:
        cost = builder.cost()
        # while the store is put together, its parts are there, too
        check_for_space(replace(cost, disk_bytes=2 * cost.disk_bytes), builder.out)
    with tqdm(unit="sequence", disable=quiet or None) as bar:

        def show(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        try:
            return builder.make(show)
        except KeyboardInterrupt:
            kept = f"{builder.finished} sequences are finished in {builder.out}; the same command makes the rest"
            raise KeyboardInterrupt(kept if builder.finished else "") from None


def _command() -> str:
    """The command line that makes the set, or the rest of it."""
    return shlex.join(["mmweaver", *sys.argv[1:]]) if sys.argv[1:2] == ["dataset"] else "mmweaver dataset"


def _rooms(arguments: argparse.Namespace, weaver: Any) -> list[Any]:
    if arguments.room and arguments.rgb:
        raise InputError("give --room folders or --rgb and --depth, not both")
    if arguments.rgb is not None:
        if arguments.depth is None:
            raise InputError("--rgb needs --depth, too: the room is built from the distance of each pixel")
        return [weaver.read_room(arguments.rgb, arguments.depth, arguments.camera)]
    if not arguments.room:
        raise InputError("which room? give --room DIR with rgb.png and depth.png, or --rgb and --depth")
    return [weaver.open_room(place) for place in arguments.room]
