"""Pictures of real rooms by both methods: physics and the network, of the same photo and sentence.

    python -m studies run learned_rooms_picture --rooms /path/to/rooms --out docs/images/weaver_rooms.png
    python -m studies run learned_rooms_picture --rooms /path/to/rooms --power weights/paper_power.safetensors \
        --out docs/images/paper_power_rooms.png

There is no ground truth for these rooms; the picture is for inspection, not for scores.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.panels import draw_azimuth_with_clutter, draw_micro_doppler, draw_photo, power_bar
from mmweaver.viz.theme import STYLE
from mmweaver.weaver.front_door import Weaver
from studies.manifest import StudyRun
from studies.scene.room_pictures import save_small
from studies.study import Reads

TEXT = "a person walks towards the radar, then waves with the left hand"
METHODS = ("physics", "weaver")
POWER = "paper_power"
FRAMES = 40


def views_of(
    folder: Path, text: str = TEXT, *, frames: int = FRAMES, seed: int = 0, power: Path | None = None
) -> dict[str, FigureData]:
    """The same room, motion and seed by each method, and with weights `power` of recipe paper_power."""
    found = {}
    methods = [Weaver(name) for name in METHODS]
    methods += [] if power is None else [Weaver.from_pretrained(power)]
    for name, weaver in zip((*METHODS, POWER), methods, strict=False):
        room = weaver.read_room(next(folder.glob("rgb.*")), folder / "depth.png", folder / "camera.json")
        made = weaver.generate(room, text, frames=frames, seed=seed, keep_adc=False, board="ideal")
        found[name] = FigureData(
            title=f"{folder.name.replace('_', ' ')}: {name}", cube=made.cube, points=made.points,
            aligned=AlignedPhoto.of(made.scene), poses=made.poses, motions=made.motions,
        )  # fmt: skip
    return found


def draw_rooms(path: Path, rooms: Sequence[dict[str, FigureData]]) -> None:
    """A row a room: the photo, then Doppler over time and range-azimuth of the static room by each method."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    count = len(rooms[0])
    with rc_context(STYLE):
        figure = Figure(figsize=(3.4 * (1 + 2 * count), 3.1 * len(rooms)), layout="constrained")
        FigureCanvasAgg(figure)
        for row, views in zip(figure.subplots(len(rooms), 1 + 2 * count, squeeze=False), rooms, strict=True):
            draw_photo(row[0], views[METHODS[0]])
            row[0].set_title(views[METHODS[0]].title.partition(":")[0])
            for index, (name, view) in enumerate(views.items()):
                over_time, above = row[1 + index], row[1 + count + index]
                draw_micro_doppler(over_time, view)
                draw_azimuth_with_clutter(above, view)
                power_bar(above, view)
                over_time.set_title(f"{name}: Doppler over time")
                above.set_title(f"{name}: the room, from above")
        save_small(figure, path)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rooms", type=Path, action=Reads, required=True, help="folders with rgb.png, depth.png and camera.json"
    )
    parser.add_argument(
        "--power", type=Path, action=Reads, help="weights of recipe paper_power, for columns of their own"
    )
    parser.add_argument("--out", type=Path, default=Path("docs/images/weaver_rooms.png"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    draw_rooms(
        options.out,
        [views_of(folder, power=options.power) for folder in sorted(options.rooms.iterdir()) if folder.is_dir()],
    )
