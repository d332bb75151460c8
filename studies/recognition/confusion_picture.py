"""Where a recogniser fails, as pictures: recorded windows that it mistakes, next to recorded and generated ones.

Of each of the largest confusions the windows at a third and at two thirds of the numbers of moving points, so that
nobody chose them.
"""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.recognition.point_recordings import PointRecording, is_moving, windows_of
from mmweaver.recognition.recogniser import Recogniser

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

CONFUSIONS, SHARES = 4, (1 / 3, 2 / 3)
REACH_M = 1.0  # shown about the median of the moving points
SHOWN_MPS = 2.5  # velocity at full colour


def confusion_picture(
    model: Recogniser, sequences: Sequence[PointRecording], recordings: Sequence[PointRecording], out: Path
) -> list[tuple[str, str]]:
    """Writes a PNG of the largest confusions, (true, recognised) label, which are returned; `sequences` trained it.

    Raises InputError where there is no window or no confusion.
    """
    made = [window for one in sequences for window in windows_of(one, model.settings)]
    real = [window for one in recordings for window in windows_of(one, model.settings)]
    if not real:
        raise InputError(f"no recording lasts {model.settings.window_s:g} s, which is one window; give longer ones")
    guess = [model.labels[index] for index in model.votes(model.features(real)).argmax(axis=1)]
    pairs = largest_confusions([window.label for window in real], guess, CONFUSIONS)
    if not pairs:
        raise InputError("no window was mistaken: there is no confusion to show")
    rows = []
    for true, taken in pairs:
        names = true.replace("_", " "), taken.replace("_", " ")
        own = [(one, found) for one, found in zip(real, guess, strict=True) if one.label == true]
        rows.append({
            f"recorded {names[0]},\ntaken for {names[1]}": [one for one, found in own if found == taken],
            f"recorded {names[0]},\nrecognised": [one for one, found in own if found == true],
            f"generated {names[0]}": [one for one in made if one.label == true],
            f"generated {names[1]}": [one for one in made if one.label == taken],
        })  # fmt: skip
    _draw(rows, model.settings.window_s, out)
    return pairs


def usual_windows(windows: Sequence[PointRecording], shares: Sequence[float]) -> list[PointRecording]:
    """The windows at these shares of their numbers of moving points; fewer of fewer windows."""
    order = np.argsort([int(is_moving(one.cloud).sum()) for one in windows])
    places = dict.fromkeys(int(share * len(windows)) for share in shares) if windows else ()
    return [windows[order[place]] for place in places]


def largest_confusions(truth: Sequence[str], guess: Sequence[str], count: int) -> list[tuple[str, str]]:
    """Pairs of true and recognised label (window,), the largest share of the true label's windows first."""
    windows, pairs = Counter(truth), Counter(zip(truth, guess, strict=True))
    shares = {pair: number / windows[pair[0]] for pair, number in sorted(pairs.items()) if pair[0] != pair[1]}
    return sorted(shares, key=lambda pair: -shares[pair])[:count]


def _draw(rows: Sequence[dict[str, list[PointRecording]]], seconds: float, path: Path) -> None:
    """Two rows per confusion, range and height over time about the median of the moving points."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.8, 2.7 * len(rows)), layout="constrained", dpi=90)
    axes = figure.subplots(2 * len(rows), 4 * len(SHARES), sharex=True, sharey=True, squeeze=False)
    axes[0, 0].set(xlim=(0.0, seconds), ylim=(-REACH_M, REACH_M))
    colours = ScalarMappable(Normalize(-SHOWN_MPS, SHOWN_MPS), "coolwarm")
    for row, groups in enumerate(rows):
        for group, (title, windows) in enumerate(groups.items()):
            shown = usual_windows(windows, SHARES)
            for place in range(len(SHARES)):
                upper, lower = axes[2 * row : 2 * row + 2, len(SHARES) * group + place]
                if place < len(shown):
                    upper.set_title(title, fontsize=8)
                    _scatter(upper, shown[place], shown[place].cloud.range_m, colours)
                    _scatter(lower, shown[place], shown[place].cloud.z_m, colours)
                else:  # nothing of this kind
                    upper.set_axis_off()
                    lower.set_axis_off()
        axes[2 * row, 0].set_ylabel("range, m", fontsize=8)
        axes[2 * row + 1, 0].set_ylabel("height, m", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("time, s", fontsize=8)
    bar = figure.colorbar(colours, ax=axes, aspect=60, fraction=0.02, pad=0.01, extend="both")
    bar.set_label("radial velocity, m/s: blue approaches, red recedes; points at rest are grey", fontsize=8)
    bar.ax.tick_params(labelsize=8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png")


def _scatter(axis: "Axes", window: PointRecording, values: np.ndarray, colours: "ScalarMappable") -> None:
    moving, time_s = is_moving(window.cloud), window.cloud.frame / window.frame_rate_hz
    if len(values):
        values = values - np.median(values[moving] if moving.any() else values)
    axis.scatter(time_s[~moving], values[~moving], s=1, color="0.8", linewidths=0)
    velocity = window.cloud.radial_velocity_mps[moving]
    axis.scatter(time_s[moving], values[moving], s=5, c=colours.to_rgba(velocity), linewidths=0)
