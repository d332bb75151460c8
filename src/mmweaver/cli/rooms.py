"""mmweaver rooms: furnished rooms with photo, depth, classes and truth, made from a seed."""

import argparse
import json
from pathlib import Path
from typing import Any

from mmweaver.cli.arguments import add_output_options, whole
from mmweaver.cli.config_file import write_request
from mmweaver.core.errors import InputError

EXAMPLES = """examples:
  mmweaver rooms rooms/ --kinds office,kitchen --layouts 3 --seed 1
  mmweaver rooms rooms/ --layouts 10 --lighting evening --noise        # all kinds
  mmweaver generate --rgb rooms/office_00/rgb.png --depth rooms/office_00/depth.png \\
      --camera rooms/office_00/camera.json --text "a person sits and drinks" --out drink/
"""
MOST_ROOMS = 10_000


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "rooms", help="generate furnished rooms with photo, depth and ground truth", epilog=EXAMPLES,
        description="Generates furnished rooms from a seed. Each is a folder: rgb.png, depth.png and camera.json, which"
        " generate reads; classes.png with its names in classes.json (COCO-Stuff); truth.json with the floor, seats,"
        " landmarks and every box of furniture. request.toml repeats the run.",
    )  # fmt: skip
    parser.add_argument("out", type=Path, metavar="OUT", help="folder for the rooms, one folder each")
    parser.add_argument("--kinds", metavar="KIND,...", help="kinds of rooms, with commas (default: all)")
    parser.add_argument("--layouts", type=whole, default=1, metavar="N", help="furniture layouts of each (default 1)")
    parser.add_argument("--seed", type=whole, default=0, help="the same seed gives the same bits (default 0)")
    parser.add_argument(
        "--lighting", default="", metavar="NAME", help="day, lamps, evening or tubes (default: in turn)"
    )
    parser.add_argument("--noise", action="store_true", help="depth with the errors and holes of a stereo camera")
    add_output_options(parser)
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Checks all that is cheap, then makes all rooms or none. Raises InputError."""
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import staged_folder
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.scene.procedural.lighting import LIGHTINGS
    from mmweaver.scene.procedural.procedural_room import MAX_LAYOUTS, make_room
    from mmweaver.scene.procedural.room_files import write_room
    from mmweaver.scene.procedural.room_kinds import KINDS

    kinds = list(KINDS) if arguments.kinds is None else [word.strip() for word in arguments.kinds.split(",")]
    for kind in kinds:
        KINDS[kind]
    lightings = [LIGHTINGS[arguments.lighting].name] if arguments.lighting else list(LIGHTINGS)
    if not 1 <= arguments.layouts <= MAX_LAYOUTS or arguments.layouts * len(kinds) > MOST_ROOMS:
        raise InputError(f"--layouts must be 1 to {MAX_LAYOUTS}, and at most {MOST_ROOMS} rooms are made at a time")
    if arguments.seed < 0:
        raise InputError(f"the seed must be 0 or above, not {arguments.seed}")
    check_output_folder(arguments.out, overwrite=arguments.overwrite)
    if arguments.overwrite and arguments.out.is_dir() and any(arguments.out.iterdir()):
        raise InputError(f"{arguments.out} holds rooms already; rooms are not mixed: choose another folder")
    names = []
    with StageBar(arguments.layouts * len(kinds), quiet=arguments.quiet) as bar, staged_folder(arguments.out) as stage:
        for kind in dict.fromkeys(kinds):
            for layout in range(arguments.layouts):
                name = f"{kind}_{layout:02d}"
                bar(name)
                room = make_room(kind, layout, arguments.seed)
                lighting = lightings[len(names) % len(lightings)]
                (stage / name).mkdir()
                write_room(stage / name, room, room.photo(lighting, arguments.noise), lighting)
                names.append(name)
        write_request(stage, arguments)
    if arguments.json:
        print(json.dumps({"out": str(arguments.out), "rooms": names, "seed": arguments.seed}, indent=2))
    elif not arguments.quiet:
        print(f"wrote {len(names)} rooms to {arguments.out}: {names[0]}{' ... ' + names[-1] if len(names) > 1 else ''}")
    return 0
