"""mmweaver dataset: procedural rooms, people and motions, and the radar signal of each."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.activity_set import OF_ROOM_SETS, add_activity_options, is_activity_set_asked, run_activity_set
from mmweaver.cli.arguments import add_board_option, add_board_options, add_range_options, radar_of, source, whole
from mmweaver.cli.config_file import write_request
from mmweaver.core.errors import InputError

MOST_WORKERS = 1024
EXAMPLES = """examples:
  mmweaver dataset set/ --room lab/ --activities activities.toml --each 50     # labelled, in your own room
  mmweaver dataset data/ --layouts 10 --sequences 120 --workers 4
  mmweaver dataset small/ --rooms "living_room,office" --layouts 2 --sequences 12
  mmweaver dataset light/ --geometry-only       # signals are made while training
  mmweaver dataset data/ --workers 4            # after a kill: resumes where it stopped
  mmweaver dataset data/ --repair               # makes rooms that mmweaver verify finds damaged anew
  mmweaver dataset data/ --dry-run              # what it would hold and cost
  mmweaver dataset shared/data/ --ray-address auto --workers 64     # on a Ray cluster that sees the folder
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "dataset",
        help="generate a data set of rooms, motions and radar signals",
        epilog=EXAMPLES,
        description="Generates furnished rooms, renders them from the radar's position, lets people move in them and "
        "writes radar signals, poses and photos as one Zarr group per room. The same settings give the same bits; "
        "finished rooms are kept, so it may be stopped and started again.",
    )
    parser.add_argument("out", type=Path, metavar="OUT", help="folder of the data set")
    add_activity_options(parser.add_argument_group("labelled activities in your own rooms"))
    content = parser.add_argument_group("content")
    content.add_argument("--rooms", metavar="KIND,...", help="kinds of rooms (default: all)")
    content.add_argument(
        "--layouts", type=whole, default=OF_ROOM_SETS["layouts"], help="furniture layouts of each kind (default 10)"
    )
    content.add_argument(
        "--sequences", type=whole, default=OF_ROOM_SETS["sequences"], help="sequences in each room (default 120)"
    )
    content.add_argument(
        "--frames", type=whole, default=OF_ROOM_SETS["frames"], help="radar frames of each sequence (default 20)"
    )
    content.add_argument(
        "--radar", type=source, default="awr1843", metavar="NAME|FILE", help="preset, TI .cfg or radar.json"
    )
    add_range_options(content)
    add_board_option(content)
    add_board_options(content)
    content.add_argument("--seed", type=whole, default=0, help="the same seed gives the same bits (default 0)")
    content.add_argument(
        "--geometry-only", action="store_true",
        help="store prepared rooms, motions and visibility, but no signals: mmweaver train makes these as it goes, with"
        " new micro-motion each time, without a ray caster, on a GPU if there is one",
    )  # fmt: skip
    running = parser.add_argument_group("running")
    running.add_argument("--workers", type=whole, default=1, help="parallel processes (default 1)")
    running.add_argument("--ray-address", metavar="ADDRESS", help="run on this Ray cluster; 'local' starts one")
    running.add_argument(
        "--repair", action="store_true",
        help="check the rooms that are there against their checksums first, and make damaged ones anew",
    )  # fmt: skip
    running.add_argument("--dry-run", action="store_true", help="print what would be made and its cost, and stop")
    output = parser.add_argument_group("output")
    output.add_argument("--json", action="store_true", help="print a machine-readable summary on stdout")
    output.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Generates what is missing. Raises InputError."""
    if is_activity_set_asked(arguments):
        return run_activity_set(arguments)
    import json
    import sys
    from dataclasses import asdict

    from tqdm import tqdm

    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.core.range_window import chosen_range
    from mmweaver.datasets.dataset_cost import check_for_space, estimate_cost
    from mmweaver.datasets.dataset_plan import MOST, DatasetPlan
    from mmweaver.datasets.dataset_store import PLAN_FILE
    from mmweaver.datasets.generate_rooms import check_packages, generate_dataset
    from mmweaver.formats.radar_file import load_radar

    workers = arguments.workers
    for name, most in (("layouts", MOST), ("sequences", MOST), ("frames", MOST), ("workers", MOST_WORKERS)):
        if not 1 <= getattr(arguments, name) <= most:
            raise InputError(f"--{name} must be 1 to {most}, not {getattr(arguments, name)}")
    config = chosen_range(load_radar(radar_of(arguments) or "awr1843"), arguments.range_m, arguments.range_bins)
    plan = DatasetPlan(
        kinds=_kinds(arguments.rooms), lightings=_lightings(), num_layouts=arguments.layouts,
        sequences_a_room=arguments.sequences, num_frames=arguments.frames, radar=config.name, seed=arguments.seed,
        geometry_only=arguments.geometry_only, board=_board(arguments),
    )  # fmt: skip
    cost = estimate_cost(plan, config, arguments.out)
    if arguments.dry_run:
        print(json.dumps(asdict(cost)) if arguments.json else cost.summary(workers))
        return 0
    check_packages(arguments.ray_address)
    if not (arguments.quiet or arguments.json):
        print(cost.summary(workers), file=sys.stderr)
    check_output_folder(arguments.out, overwrite=True, files=[PLAN_FILE])
    check_for_space(cost, arguments.out)
    total = len(plan.kinds) * plan.num_layouts
    try:
        with tqdm(total=total, unit="room", disable=arguments.quiet or None) as bar:
            reports = generate_dataset(
                arguments.out, plan, config, workers=workers, ray_address=arguments.ray_address,
                listener=lambda report: bar.update(), repair=arguments.repair,
            )  # fmt: skip
    except KeyboardInterrupt:
        left = estimate_cost(plan, config, arguments.out).rooms
        kept = f"{total - left} of {total} rooms are finished in {arguments.out}; the same command makes the rest"
        raise KeyboardInterrupt(kept if arguments.out.exists() else "") from None
    write_request(arguments.out, arguments)
    summary = {
        "out": str(arguments.out),
        "rooms_made": len(reports),
        "rooms_already_there": total - len(reports),
        "sequences_made": sum(report.num_sequences for report in reports),
        "sequences_refused": sum(len(report.refused) for report in reports),
    }
    if arguments.json:
        print(json.dumps(summary))
    elif not arguments.quiet:
        print(
            f"{summary['sequences_made']} sequences in {len(reports)} new rooms ({summary['rooms_already_there']} were"
            f" there) in {arguments.out}"
        )
    return 0


def _board(arguments: argparse.Namespace) -> str:
    """The board of the plan: a file by its whole path. Raises InputError where it cannot be read."""
    name = arguments.board or ("ideal" if arguments.geometry_only else "typical")
    return str(Path(name).absolute()) if Path(name).is_file() else name


def _kinds(text: str | None) -> tuple[str, ...]:
    from mmweaver.scene.procedural.room_kinds import KINDS

    known = tuple(KINDS)
    if text is None:
        return known
    kinds = tuple(part.strip() for part in text.split(","))
    for kind in kinds:
        if kind not in known:
            raise InputError(f"unknown kind of room {kind!r}; known: {', '.join(known)}")
    return kinds


def _lightings() -> tuple[str, ...]:
    from mmweaver.scene.procedural.lighting import LIGHTINGS

    return tuple(LIGHTINGS)
