"""The panel of the photo: the people in it at several times."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.records import PoseSequence
from mmweaver.figures.body_in_photo import BodyPainter, Colour, PhotoPixels
from mmweaver.figures.body_rasteriser import Body, bodies_of
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.theme import TIME_MAP, person_colour, time_bar
from mmweaver.geometry.aligned_photo import AlignedPhoto

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PHOTO_WIDTH_PX = 720  # about the width of the photo on the page
SHOWN_POSES = 7  # bodies drawn into the photo
SHOWN_POSES_OF_MANY = 3  # bodies per person of several people


def draw_photo(axes: "Axes", view: FigureData) -> None:
    """The photo with the bodies at several times; what furniture occludes is hidden but for a hint."""
    import matplotlib
    from matplotlib.colors import to_rgb

    assert view.aligned is not None
    people = view.shown_poses
    if len(people) == 1:
        colours = matplotlib.colormaps[TIME_MAP]
        bodies = _bodies(people[0], SHOWN_POSES, lambda share: _time_colour(colours, share))
        axes.set_title("The room, and the person at several times", y=1.0)
    elif not people:
        bodies = []
        axes.set_title("The room, with nobody in it", y=1.0)
    else:
        bodies = []
        for index, person in enumerate(people):
            bodies += _bodies(
                person, SHOWN_POSES_OF_MANY, partial(_brightened, to_rgb(person_colour(index, len(people))))
            )
        axes.set_title("The room, and the people at several times, the last the brightest", y=1.0)
    _show_photo(axes, view.aligned, bodies)
    if len(people) == 1 and len(people[0].time_s) > 1:
        time_bar(axes, _time_map(), float(people[0].time_s[0]), float(people[0].time_s[-1]))


def _show_photo(axes: "Axes", aligned: AlignedPhoto, bodies: list[tuple[Body, Colour]]) -> None:
    """The photo with bodies painted into it, at about the size that the page has for it."""
    from PIL import Image

    height, width = aligned.photo.rgb.shape[:2]
    size = (max(round(height * PHOTO_WIDTH_PX / width), 1), PHOTO_WIDTH_PX)
    picture = np.array(Image.fromarray(aligned.photo.rgb).resize(size[::-1], Image.Resampling.BILINEAR))
    BodyPainter(PhotoPixels.whole(aligned, size)).paint(picture, bodies)
    axes.imshow(picture, extent=(-0.5, width - 0.5, height - 0.5, -0.5), interpolation="antialiased")
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
    axes.set_anchor("NW")


def _bodies(pose: PoseSequence, most: int, colour_at: Callable[[float], Colour]) -> list[tuple[Body, Colour]]:
    """One person at several times, in colours by the share of the time."""
    count = len(pose.time_s)
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    shares = np.arange(len(chosen)) / max(len(chosen) - 1, 1)
    return [(body, colour_at(float(share))) for body, share in zip(bodies_of(pose, chosen), shares, strict=True)]


def _brightened(colour: Colour, share: float) -> Colour:
    """A person's colour, darker at earlier times."""
    red, green, blue = (one * (0.5 + 0.5 * share) for one in colour)
    return red, green, blue


def _time_colour(colours: "Callable[[float], tuple[float, ...]]", share: float) -> Colour:
    red, green, blue, _ = colours(0.25 + 0.75 * share)  # the dark end of the map is invisible on a photo
    return float(red), float(green), float(blue)


def _time_map():
    import matplotlib
    from matplotlib.colors import ListedColormap

    return ListedColormap(matplotlib.colormaps[TIME_MAP](np.linspace(0.25, 1, 128)))
