"""What a background recording is worth: pictures of ground truth, the network from the photo alone, and with it.

    python -m studies run background_rooms --out docs/images/weaver_empty_room.png

Procedural rooms of kinds that the network never saw. The simulator in the true room is the ground truth and, with
nobody there, the recording; motion and person are the same in all three, the phases of the skin are not. Scores:
`learned_scores`.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mmweaver.core.presets import AWR1843
from mmweaver.dsp.cube import radar_cube
from mmweaver.dsp.points import point_cloud
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.photo_panel import draw_photo
from mmweaver.figures.power_panels import draw_azimuth_with_clutter, power_bar
from mmweaver.figures.theme import STYLE
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.static_paths import ALL_PATHS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from studies.manifest import StudyRun
from studies.scene.room_pictures import save_small

TEXT = "a person walks to the left"
KINDS = ("living_room", "classroom", "workshop")
SEED = 4000  # of no data set
TITLES = ("truth: the room, from above", "the photo alone", "with a recording of the empty room")
OTHER_SKIN = 1000


def views_of(kind: str, *, frames: int = 20) -> list[FigureData]:
    """Ground truth, the network from the photo alone, and with the recording."""
    made_room = make_room(kind, 0, SEED)
    true_room = Simulator(made_room.scene(), AWR1843, propagation=ALL_PATHS)
    recording = radar_cube(true_room.run((), num_frames=frames, seed=1).adc)
    room = Room(scene=reconstruct(made_room.photo()), inputs={}, seconds={})
    weaver = Weaver("weaver", AWR1843)
    found = [
        weaver.generate(one, TEXT, frames=frames, board="ideal") for one in (room, room.with_background(recording))
    ]
    person = replace(found[0].motion, subject=found[0].motion.subject + OTHER_SKIN)
    truth = radar_cube(true_room.run(person, num_frames=frames, seed=2).adc)
    cubes = (truth, *(one.cube for one in found))
    return [
        FigureData(
            title=kind.replace("_", " "), cube=cube, points=point_cloud(cube),
            aligned=AlignedPhoto.of(room.scene), poses=found[0].poses, motions=found[0].motions,
        )
        for cube in cubes
    ]  # fmt: skip


def draw_rooms(path: Path, rooms: Sequence[Sequence[FigureData]]) -> None:
    """A row a room: the photo, and range-azimuth three times."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        figure = Figure(figsize=(15, 2.2 * len(rooms)), layout="constrained")
        FigureCanvasAgg(figure)
        for row, views in zip(figure.subplots(len(rooms), 1 + len(TITLES), squeeze=False), rooms, strict=True):
            draw_photo(row[0], views[0])
            row[0].set_title(views[0].title)
            for axes, view, title in zip(row[1:], views, TITLES, strict=True):
                draw_azimuth_with_clutter(axes, view)
                power_bar(axes, view)
                axes.set_title(title)
        save_small(figure, path)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, default=Path("docs/images/weaver_empty_room.png"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    draw_rooms(options.out, [views_of(kind) for kind in KINDS])
