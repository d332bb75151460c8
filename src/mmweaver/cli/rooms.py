"""mmweaver rooms: furnished rooms with photo, depth, classes and truth, made from a seed."""

from pathlib import Path

from mmweaver.cli.arguments import write_request
from mmweaver.cli.option_groups import Written
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver rooms rooms/ --rooms office,kitchen --layouts 3 --seed 1
  mmweaver rooms rooms/ --layouts 10 --noise        # all kinds
  mmweaver generate --rgb rooms/office_00/rgb.png --depth rooms/office_00/depth.png \\
      --camera rooms/office_00/camera.json --text "a person sits and drinks" --out drink/
"""
MOST_ROOMS = 10_000


@options
class Options(Written):
    """Generates furnished rooms from a seed. Each is a folder: rgb.png, depth.png and camera.json, which generate
    reads; classes.png with its names in classes.json (COCO-Stuff); truth.json with the floor, seats,
    landmarks and every box of furniture. request.toml repeats the run.
    """

    out: Path = option("folder for the rooms, one each", "OUT", default=MISSING, positional=True, is_setting=False)
    rooms: tuple[str, ...] | None = option("kinds of rooms (default: all)", "KIND,...")
    layouts: int = option("furniture layouts of each kind", "N", default=1)
    seed: int = option("the same seed gives the same bits", "N", default=0)
    noise: bool = option("depth with the errors and holes of a stereo camera", default=False)


def run(asked: Options) -> int:
    """Checks everything that is fast to check, then makes all rooms or none.

    Raises:
        InputError: For options that cannot be used.
    """
    from mmweaver.cli.progress import StageBar
    from mmweaver.core.atomic_files import staged_folder
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.scene.procedural.arrangement import KINDS
    from mmweaver.scene.procedural.lighting import LIGHTINGS
    from mmweaver.scene.procedural.procedural_room import MAX_LAYOUTS, make_room
    from mmweaver.scene.procedural.room_files import write_room

    kinds = list(KINDS) if asked.rooms is None else [word.strip() for word in asked.rooms]
    for kind in kinds:
        KINDS[kind]
    lightings = list(LIGHTINGS)
    if not 1 <= asked.layouts <= MAX_LAYOUTS or asked.layouts * len(kinds) > MOST_ROOMS:
        raise InputError(f"--layouts must be 1 to {MAX_LAYOUTS}, and at most {MOST_ROOMS} rooms are made at a time")
    if asked.seed < 0:
        raise InputError(f"the seed must be 0 or above, not {asked.seed}")
    check_output_folder(asked.out, overwrite=asked.overwrite)
    if asked.overwrite and asked.out.is_dir() and any(asked.out.iterdir()):
        raise InputError(f"{asked.out} holds rooms already; rooms are not mixed: choose another folder")
    names = []
    with StageBar(asked.layouts * len(kinds), quiet=asked.quiet) as bar, staged_folder(asked.out) as stage:
        for kind in dict.fromkeys(kinds):
            for layout in range(asked.layouts):
                name = f"{kind}_{layout:02d}"
                bar(name)
                room = make_room(kind, layout, asked.seed)
                lighting = lightings[len(names) % len(lightings)]
                (stage / name).mkdir()
                write_room(stage / name, room, room.photo(lighting, asked.noise), lighting)
                names.append(name)
        write_request(stage, asked)
    shown = names[0] + (f" ... {names[-1]}" if len(names) > 1 else "")
    summary = {"out": str(asked.out), "rooms": names, "seed": asked.seed}
    return asked.report(summary, f"wrote {len(names)} rooms to {asked.out}: {shown}")
