"""mmweaver dataset: procedural rooms, people and motions, and the radar signal of each; or a labelled set."""

import sys
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

from mmweaver.cli.arguments import write_request
from mmweaver.cli.option_groups import BoardChoice, Iq, Printed, RadarChoice, Ranges
from mmweaver.core.errors import InputError
from mmweaver.core.options import MISSING, option, options

if TYPE_CHECKING:
    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.datasets.dataset_plan import DatasetPlan

MAX_WORKERS = 1024
EXAMPLES = """examples:
  mmweaver dataset set/ --room lab/ --activities activities.toml --per-class 50   # labelled, in your own room
  mmweaver dataset data/ --layouts 10 --sequences 120 --workers 4
  mmweaver dataset small/ --rooms "living_room,office" --layouts 2 --sequences 12
  mmweaver dataset light/ --geometry-only       # signals are made while training
  mmweaver dataset data/ --workers 4            # after a kill: resumes where it stopped
  mmweaver dataset data/ --repair               # makes rooms that mmweaver verify finds damaged anew
  mmweaver dataset data/ --dry-run              # what it would hold and cost
  mmweaver dataset data/ --layouts 7000 --packed --part 3/100    # the third of a hundred machines, one file per room
  mmweaver dataset shared/data/ --ray-address auto --workers 64     # on a Ray cluster that sees the folder
"""


@options
class LabelledSet:
    """Options that need --activities or --from-results."""

    activities: Path | None = option(
        'a file with a table [activities] of lines such as: waving = ["a person waves with the left hand"]',
        "TOML",
        group="labelled activities in your own rooms",
    )
    room: list[Path] | None = option(
        "a folder with rgb.png, depth.png and camera.json (mmweaver rooms makes such folders), views.json, a scan, a"
        " capture folder, a ROS bag or a mesh; once more for each further room",
        "DIR",
    )
    from_results: Path | None = option(
        "instead of making sequences: the result folders in DIR, as mmweaver generate --texts writes them, become one"
        " set; without --activities each sentence is a label",
        "DIR",
    )
    per_class: int | None = option("sequences of each label (default 20)", "N")
    seconds: float | None = option("duration of every sequence in seconds (default 3)", "S")
    subjects: int | None = option("different people (default 10)", "N")
    split: Literal["subject", "place", "room", "sentence"] | None = option(
        "what is held out for tests (default subject)"
    )
    strict: bool = option(
        "take no place where something is not done as the sentence says, measured on the joints", default=False
    )
    method: str | None = option("weaver, the network (default), or physics", "NAME")
    iq: Iq | None = option(
        "how signals are stored (default float16, an error below 0.05 %); none: joints, points and what signals are"
        " made from when they are read, in a thirtieth of the space"
    )


@options
class RoomSet:
    """Options of data sets of procedural rooms."""

    rooms: tuple[str, ...] | None = option("kinds of rooms (default: all)", "KIND,...", group="content")
    layouts: int = option("furniture layouts of each kind", "N", default=10)
    sequences: int = option("sequences in each room", "N", default=120)
    frames: int = option("radar frames of each sequence", "N", default=20)
    geometry_only: bool = option(
        "store prepared rooms, motions and visibility, but no signals: mmweaver train makes these as it goes, with new"
        " micro-motion each time, without a ray caster, on a GPU if there is one",
        default=False,
    )
    packed: bool = option(
        "write each room as one uncompressed zip, which Zarr reads, instead of a folder of some 30 files",
        default=False,
    )
    plan_version: int = option(
        "4, or 3 for the seeds of sets made by mmweaver 0.3; a set that is there keeps its own", "N", default=4
    )
    part: str | None = option(
        "make only the rooms of this machine, for example 3/100 for the third of a hundred: all may run at once, each"
        " on a range of rooms, and any of them again after a kill",
        "I/N",
        group="running",
        is_setting=False,
    )
    workers: int = option("parallel processes", "N", default=1, is_setting=False)
    ray_address: str | None = option("run on this Ray cluster; 'local' starts one", "ADDRESS", is_setting=False)
    repair: bool = option(
        "check the rooms that are there against their checksums first, and make damaged ones anew", default=False
    )


@options
class Options(LabelledSet, RoomSet, RadarChoice, Ranges, BoardChoice, Printed):
    """Generates furnished rooms, renders them from the radar's position, lets people move in them and writes radar
    signals, poses and photos as one Zarr group per room. The same settings give the same bits; finished rooms are kept,
    so it may be stopped and started again.
    """

    GROUPS: ClassVar[dict[str, str]] = {"radar": "radar", "json": "output"}

    out: Path = option("folder of the data set", "OUT", default=MISSING, positional=True, is_setting=False)
    seed: int = option("the same seed gives the same bits", "N", default=0)
    dry_run: bool = option("print what would be made and its cost, and stop", default=False, is_setting=False)

    def radar_config(self) -> "RadarConfig":
        """The radar that records, with its range window.

        Raises:
            InputError: For an unknown radar or an impossible range.
        """
        from mmweaver.core.range_window import chosen_range
        from mmweaver.io.radar_file import load_radar

        return chosen_range(load_radar(self.radar_name("awr1843") or ""), self.range_m, self.range_bins)


def run(asked: Options) -> int:
    """Generates what is missing of a data set.

    Raises:
        InputError: For options or files that cannot be used.
    """
    if asked.activities is not None or asked.from_results is not None:
        from mmweaver.cli.activity_set import run_activity_set

        for one in fields(RoomSet):
            if getattr(asked, one.name) != one.default:
                name = one.name.replace("_", "-")
                raise InputError(f"--{name} is for data sets of rooms; leave it out of a labelled set")
        return run_activity_set(asked)
    for one in fields(LabelledSet):
        if getattr(asked, one.name) != one.default:
            raise InputError(f"--{one.name.replace('_', '-')} is for labelled sets; give --activities, too")
    return _run_rooms(asked)


def _run_rooms(asked: Options) -> int:
    from tqdm import tqdm

    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.datasets.dataset_cost import check_for_space, estimate_cost
    from mmweaver.datasets.dataset_folder import PLAN_FILE
    from mmweaver.datasets.dataset_plan import MOST, DatasetPlan, begun_version
    from mmweaver.scene.procedural.arrangement import KINDS
    from mmweaver.scene.procedural.lighting import LIGHTINGS

    out, workers = asked.out, asked.workers
    for name, limit in (("layouts", MOST), ("sequences", MOST), ("frames", MOST), ("workers", MAX_WORKERS)):
        if not 1 <= getattr(asked, name) <= limit:
            raise InputError(f"--{name} must be 1 to {limit}, not {getattr(asked, name)}")
    for kind in asked.rooms or ():
        KINDS[kind.strip()]
    config = asked.radar_config()
    board = asked.board or ("ideal" if asked.geometry_only else "typical")
    plan = DatasetPlan(
        kinds=tuple(kind.strip() for kind in asked.rooms or KINDS),
        lightings=tuple(LIGHTINGS),
        num_layouts=asked.layouts,
        sequences_a_room=asked.sequences,
        num_frames=asked.frames,
        radar=config.name,
        seed=asked.seed,
        geometry_only=asked.geometry_only,
        board=str(Path(board).absolute()) if Path(board).is_file() else board,
        packed=asked.packed,
        plan_version=begun_version(out) or asked.plan_version,
    )
    numbers = _part(asked.part, plan)
    cost = estimate_cost(plan, config, out, numbers)
    if asked.dry_run:
        return asked.report(asdict(cost), cost.summary(workers))
    from mmweaver.datasets.generate_rooms import check_packages, generate_dataset

    check_packages(asked.ray_address)
    check_output_folder(out, overwrite=True, files=[PLAN_FILE])
    check_for_space(cost, out)
    if not (asked.quiet or asked.json):
        print(cost.summary(workers), file=sys.stderr)
    total = len(numbers)
    try:
        with tqdm(total=total, unit="room", disable=asked.quiet or None) as bar:
            reports = generate_dataset(
                out,
                plan,
                config,
                workers=workers,
                ray_address=asked.ray_address,
                repair=asked.repair,
                numbers=numbers,
                listener=lambda report: bar.update(),
            )
    except KeyboardInterrupt:
        left = estimate_cost(plan, config, out, numbers).rooms
        kept = f"{total - left} of {total} rooms are finished in {out}; the same command makes the rest"
        raise KeyboardInterrupt(kept if out.exists() else "") from None
    write_request(out, asked)
    summary = {
        "out": str(out),
        "rooms_made": len(reports),
        "rooms_already_there": total - len(reports),
        "sequences_made": sum(report.num_sequences for report in reports),
        "sequences_refused": sum(len(report.refused) for report in reports),
    }
    rooms = f"{len(reports)} new rooms ({total - len(reports)} were there)"
    return asked.report(summary, f"{summary['sequences_made']} sequences in {rooms} in {out}")


def _part(words: str | None, plan: "DatasetPlan") -> range:
    """Rooms of this machine. Raises InputError if the option is not like 3/100."""
    first, slash, last = (words or "1/1").partition("/")
    if not (slash and first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last)):
        raise InputError(f"--part must be like 3/100, the third of a hundred parts, not {words!r}")
    return plan.part(int(first), int(last))
