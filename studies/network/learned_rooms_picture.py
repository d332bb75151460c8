"""Pictures of real rooms by both methods: physics and the network, of the same photo and sentence.

    python -m studies run learned_rooms_picture --rooms /path/to/rooms --out docs/images/weaver_rooms.png

There is no ground truth for these rooms; the picture is for inspection, not for scores.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.photo_panel import draw_photo
from mmweaver.figures.power_panels import draw_azimuth_with_clutter, draw_micro_doppler, power_bar
from mmweaver.figures.theme import STYLE
from mmweaver.generate import Weaver
from mmweaver.geometry.aligned_photo import AlignedPhoto
from studies.manifest import StudyRun
from studies.scene.room_pictures import save_small
from studies.study import Reads

TEXT = "a person walks towards the radar, then waves with the left hand"
METHODS = ("physics", "weaver")
FRAMES = 40


def views_of(folder: Path, text: str = TEXT, *, frames: int = FRAMES, seed: int = 0) -> dict[str, FigureData]:
    """The same room, motion and seed by each method."""
    found = {}
    for name in METHODS:
        weaver = Weaver(name)
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

    with rc_context(STYLE):
        figure = Figure(figsize=(17, 3.1 * len(rooms)), layout="constrained")
        FigureCanvasAgg(figure)
        for row, views in zip(figure.subplots(len(rooms), 5, squeeze=False), rooms, strict=True):
            draw_photo(row[0], views[METHODS[0]])
            row[0].set_title(views[METHODS[0]].title.partition(":")[0])
            for index, name in enumerate(METHODS):
                draw_micro_doppler(row[1 + index], views[name])
                draw_azimuth_with_clutter(row[3 + index], views[name])
                power_bar(row[3 + index], views[name])
                row[1 + index].set_title(f"{name}: Doppler over time")
                row[3 + index].set_title(f"{name}: the room, from above")
        save_small(figure, path)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rooms", type=Path, action=Reads, required=True, help="folders with rgb.png, depth.png and camera.json"
    )
    parser.add_argument("--out", type=Path, default=Path("docs/images/weaver_rooms.png"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    draw_rooms(options.out, [views_of(folder) for folder in sorted(options.rooms.iterdir()) if folder.is_dir()])
