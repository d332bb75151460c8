"""One look for all pictures: one colour map for power, one for time, one for radial velocity."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

POWER_MAP = "inferno"
TIME_MAP = "viridis"
VELOCITY_MAP = "coolwarm"
SPAN_DB = 50.0  # what a power picture shows below its peak

INK = "#22262b"
PAPER = "#ffffff"
_BEYOND_FONT = 0x2E80
TRUTH = "#7fe3ff"  # what is known from the skeleton, drawn over what the radar saw
# The same for several people: bright over power maps and photos, dark on white.
PEOPLE = (TRUTH, "#8dff7a", "#ff9df2", "#ffffff", "#ffd24d", "#b3a6ff", "#5dffd0", "#ff8f70")
PEOPLE_ON_WHITE = ("#0b7da3", "#1f8a0f", "#b02fa0", "#5b6168", "#a07400", "#5b48c9", "#00856a", "#c2431c")

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.titlepad": 6.0,
    "axes.labelsize": 9.0,
    "axes.labelpad": 2.0,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.7,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "text.color": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


def label_axes(axes: "Axes", title: str, x_label: str, y_label: str) -> None:
    """Title above on the left, a label on either axis."""
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)


def colour_bar(axes: "Axes", mappable: "ScalarMappable", label: str) -> None:
    """A thin bar at the right of the axes, without taking room from them."""
    place = axes.inset_axes((1.02, 0.0, 0.035, 1.0))
    bar = axes.figure.colorbar(mappable, cax=place)
    bar.set_label(label, fontsize=8, labelpad=3)
    bar.outline.set_linewidth(0.5)  # type: ignore[operator]
    place.tick_params(labelsize=7, width=0.5, length=2)


def person_colour(index: int, count: int, *, on_white: bool = False) -> str:
    """A person's colour; one alone has the usual ones.

    >>> person_colour(0, 1) == TRUTH, person_colour(0, 1, on_white=True) == INK
    (True, True)
    """
    if on_white:
        return INK if count == 1 else PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
    return PEOPLE[index % len(PEOPLE)]


def shortened(text: str, most: int) -> str:
    """At most so many characters, without those that the font has not (emoji and the like).

    >>> shortened("a person walks", 10)
    'a perso...'
    >>> shortened("a person waves \U0001f44b", 20)
    'a person waves '
    """
    text = "".join(character for character in text if ord(character) < _BEYOND_FONT)
    return text if len(text) <= most else text[: most - 3] + "..."
