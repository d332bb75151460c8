"""Pictures of six sentences in each photographed room: the body in the photo, top view, spectrograms.

python -m studies run room_sentences --rooms /path/to/rooms --out docs/images
"""

import argparse
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.figures.body_in_photo import BodyPainter, PhotoPixels
from mmweaver.figures.body_rasteriser import bodies_of
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.power_panels import draw_micro_doppler, draw_range_time, power_bar
from mmweaver.figures.theme import STYLE
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room
from studies.manifest import StudyRun
from studies.scene.room_pictures import save_small, small
from studies.scene.top_view import draw_top
from studies.study import Reads

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SENTENCES = {
    "kinect2_living_room": (
        "user seated on couch drinking water", "a person walks towards the radar, then waves with the left hand",
        "she sits down on the couch", "someone does jumping jacks", "a man boxes quickly",
        "he stands up",
    ),
    "kinect_dining_room": (
        "a person walks away from the radar", "someone waves with both hands", "she claps",
        "a man walks towards the radar and stops", "he squats", "she raises her right hand",
    ),
    "redwood_chair_corner": (
        "a person waves with the right hand", "someone claps", "she squats", "he jumps",
        "a woman raises her left hand", "a man boxes",
    ),
    "tum_office_desk": (
        "a person sits and drinks", "someone walks to the right, then claps", "a man does jumping jacks",
        "she walks towards the radar", "he stands up and waves", "someone turns around",
    ),
}  # fmt: skip
_SHARES = (0.0, 0.5, 1.0)  # of the time at which the body is shown


def draw_room(path: Path, name: str, weaver: Weaver, room: Room, sentences: tuple[str, ...]) -> list[str]:
    """Writes one page, a row a sentence; returns the sentences that the room refused."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    refused: list[str] = []
    with matplotlib.rc_context(
        {
            **STYLE,
            "font.size": 7.0,
            "axes.titlesize": 7.5,
            "axes.labelsize": 6.5,
            "xtick.labelsize": 6,
            "ytick.labelsize": 6,
        }
    ):
        figure = Figure(figsize=(9.6, 1.95 * len(sentences) + 0.4), layout="constrained")
        FigureCanvasAgg(figure)
        figure.suptitle(f"{name}: six sentences, seeds 0 to 5", fontsize=9, fontweight="bold")
        axes = figure.subplots(len(sentences), 4, width_ratios=(1.25, 1.25, 1.1, 1.1), squeeze=False)
        for seed, (row, text) in enumerate(zip(axes, sentences, strict=True)):
            try:
                result = weaver.generate(room, text, seed=seed, keep_adc=False, board="ideal")
            except InputError as error:
                refused.append(text)
                _say(row, text, str(error))
                continue
            _draw_row(row, text, result)
        save_small(figure, path)
    return refused


def _say(row: "list[Axes]", text: str, error: str) -> None:
    for axes in row:
        axes.axis("off")
    words = textwrap.fill(f'"{text}" is refused: {error}', 110)
    row[0].text(0.0, 0.5, words, fontsize=8, transform=row[0].transAxes).set_in_layout(False)


def _draw_row(row: "list[Axes]", text: str, result: Generation) -> None:
    photo, scene = result.photo, result.scene
    height, width = photo.rgb.shape[:2]
    picture = small(photo.rgb).copy()
    painter = BodyPainter(PhotoPixels.whole(AlignedPhoto.of(scene), picture.shape[:2]))
    instants = np.round(np.array(_SHARES) * (len(result.pose.time_s) - 1)).astype(int)
    bodies = bodies_of(result.pose, instants)
    painter.paint(
        picture, [(body, (0.3 + 0.6 * share, 0.85, 0.4)) for body, share in zip(bodies, _SHARES, strict=True)]
    )
    row[0].imshow(picture, extent=(-0.5, width - 0.5, height - 0.5, -0.5))
    row[0].set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
    row[0].set_title(textwrap.shorten(text, 40, placeholder="..."))
    draw_top(row[1], scene, pose=result.motion)
    row[1].set_title("from above (m)")
    view = FigureData(
        title="", cube=result.cube, points=result.points, aligned=AlignedPhoto.of(scene),
        poses=result.poses, motions=result.motions,
    )  # fmt: skip
    draw_range_time(row[2], view)
    draw_micro_doppler(row[3], view)
    power_bar(row[3], view)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, required=True, help="folder of the four real rooms")
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    weaver = Weaver("physics")
    for name, sentences in SENTENCES.items():
        folder = options.rooms / name
        room = weaver.read_room(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
        draw_room(options.out / f"rooms_{name}.png", name, weaver, room, sentences)
