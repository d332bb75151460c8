"""mmweaver dataset: rooms, people and motions made up, and the radar signal of each."""

import argparse
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import source, whole
from mmweaver.core.errors import InputError

EXAMPLES = """examples:
  mmweaver dataset data/ --layouts 10 --sequences 120 --workers 4
  mmweaver dataset small/ --rooms "living_room,office" --layouts 2 --sequences 12
  mmweaver dataset light/ --geometry-only       # signals are made while training
  mmweaver dataset data/ --workers 4            # after a kill: goes on where it stopped
  mmweaver dataset data/ --dry-run              # what it would hold and cost
  mmweaver dataset shared/data/ --ray-address auto --workers 64     # on a Ray cluster that sees the folder
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "dataset",
        help="make a data set of rooms, motions and radar signals",
        epilog=EXAMPLES,
        description="Makes furnished rooms, photographs them from the radar's place, lets people move in them and "
        "writes the radar's signal, poses and photos as one Zarr group a room. The same settings give the same bits; "
        "what is already there is kept, so it may be stopped and started again.",
    )
    parser.add_argument("out", type=Path, metavar="OUT", help="folder of the data set")
    parser.add_argument("--rooms", metavar="KIND,...", help="kinds of rooms (default: all)")
    parser.add_argument("--layouts", type=whole, default=10, help="rearrangements of each kind (default 10)")
    parser.add_argument("--sequences", type=whole, default=120, help="sequences in each room (default 120)")
    parser.add_argument("--frames", type=whole, default=20, help="radar frames of each sequence (default 20)")
    parser.add_argument(
        "--radar", type=source, default="awr1843", metavar="NAME|FILE", help="preset, TI .cfg or radar.json"
    )
    parser.add_argument("--seed", type=whole, default=0, help="the same seed gives the same bits (default 0)")
    parser.add_argument(
        "--geometry-only", action="store_true",
        help="keep prepared rooms, motions and what hides what, but no signals: mmweaver train makes these as it goes,"
        " with new micro-phases each time, without a ray caster, on a GPU if there is one",
    )  # fmt: skip
    parser.add_argument("--workers", type=whole, default=1, help="processes at once (default 1)")
    parser.add_argument("--ray-address", metavar="ADDRESS", help="run on this Ray cluster; 'local' embeds one")
    parser.add_argument("--dry-run", action="store_true", help="tell what is to be made and what it costs, and stop")
    parser.add_argument("--json", action="store_true", help="print a summary for machines on stdout")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Makes what is missing. Raises InputError."""
    import json
    import sys
    from dataclasses import asdict

    from tqdm import tqdm

    from mmweaver.datasets.dataset_cost import check_for_space, estimate_cost
    from mmweaver.datasets.dataset_plan import DatasetPlan, check_for_leaks
    from mmweaver.datasets.generate_rooms import generate_dataset
    from mmweaver.formats.radar_file import load_radar

    config = load_radar(arguments.radar)
    plan = DatasetPlan(
        kinds=_kinds(arguments.rooms), lightings=_lightings(), num_layouts=arguments.layouts,
        sequences_a_room=arguments.sequences, num_frames=arguments.frames, radar=config.name, seed=arguments.seed,
        geometry_only=arguments.geometry_only,
    )  # fmt: skip
    workers = max(1, arguments.workers)
    check_for_leaks(plan.rooms())
    cost = estimate_cost(plan, config, arguments.out)
    if arguments.dry_run:
        print(json.dumps(asdict(cost)) if arguments.json else cost.summary(workers))
        return 0
    if not (arguments.quiet or arguments.json):
        print(cost.summary(workers), file=sys.stderr)
    check_for_space(cost, arguments.out)
    total = len(plan.kinds) * plan.num_layouts
    with tqdm(total=total, unit="room", disable=arguments.quiet or None) as bar:
        reports = generate_dataset(
            arguments.out, plan, config, workers=workers, ray_address=arguments.ray_address,
            listener=lambda report: bar.update(),
        )  # fmt: skip
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
