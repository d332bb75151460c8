"""Where a recogniser fails, as pictures: recorded windows that it mistakes, next to recorded and generated ones.

Of each of the largest confusions the windows at a third and at two thirds of the numbers of moving points, so that
nobody chose them.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Int

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.recognition.generated_sequences import stored_sequences
from mmweaver.recognition.point_recordings import PointRecording, is_moving, windows_of
from mmweaver.recognition.recogniser import Recogniser

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CONFUSIONS, SHARES = 4, (1 / 3, 2 / 3)
REACH_M = 1.0  # shown about the median of the moving points
SHOWN_MPS, COLOURS = 2.5, "coolwarm"  # velocity at full colour


def confusion_picture(
    model: Recogniser, sequences: Path, recordings: Sequence[PointRecording], out: Path
) -> list[tuple[str, str]]:
    """Writes a PNG of the largest confusions, (true, recognised) label, which are returned; `sequences` trained it.

    Raises InputError where there are no sequences or no confusion.
    """
    made = [window for one in stored_sequences(sequences, model.settings) for window in windows_of(one, model.settings)]
    real = [window for one in recordings for window in windows_of(one, model.settings)]
    if not real:
        raise InputError(f"no recording lasts {model.settings.window_s:g} s, which is one window; give longer ones")
    guess = model.votes(model.features(real)).argmax(axis=1)
    pairs = largest_confusions(np.array([model.labels.index(one.label) for one in real]), guess, CONFUSIONS)
    if not pairs:
        raise InputError("no window was mistaken: there is no confusion to show")
    draw_confusions(pairs, real, guess, made, model.labels, model.settings.window_s, out)
    return [(model.labels[true], model.labels[taken]) for true, taken in pairs]


def usual_windows(windows: Sequence[PointRecording], shares: Sequence[float]) -> list[PointRecording]:
    """The windows at these shares of their numbers of moving points; fewer of fewer windows."""
    order = np.argsort([int(is_moving(one.cloud).sum()) for one in windows])
    places = dict.fromkeys(int(share * len(windows)) for share in shares) if windows else ()
    return [windows[order[place]] for place in places]


def largest_confusions(
    truth: Int[np.ndarray, " window"], guess: Int[np.ndarray, " window"], count: int
) -> list[tuple[int, int]]:
    """Pairs of true and recognised label (window,), the largest share of the true label's windows first."""
    size = int(max(truth.max(), guess.max())) + 1
    table = np.zeros((size, size))
    np.add.at(table, (truth, guess), 1)
    table /= np.maximum(table.sum(axis=1, keepdims=True), 1)
    np.fill_diagonal(table, 0)
    order = np.argsort(-table, axis=None, kind="stable")[:count]
    return [(int(place // size), int(place % size)) for place in order if table.flat[place] > 0]


def draw_confusions(
    pairs: Sequence[tuple[int, int]], real: Sequence[PointRecording], guess: Int[np.ndarray, " window"],
    made: Sequence[PointRecording], labels: Sequence[str], seconds: float, path: Path,
) -> None:  # fmt: skip
    """Two rows a confusion, range and height over time about the median of the moving points.

    `guess`: the label that each real window was given.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.8, 2.7 * len(pairs)), layout="constrained", dpi=90)
    axes = figure.subplots(2 * len(pairs), 4 * len(SHARES), sharex=True, sharey=True, squeeze=False)
    for row, (true, taken) in enumerate(pairs):
        names = labels[true].replace("_", " "), labels[taken].replace("_", " ")
        own = [(one, found) for one, found in zip(real, guess, strict=True) if one.label == labels[true]]
        groups = {
            f"recorded {names[0]},\ntaken for {names[1]}": [one for one, found in own if found == taken],
            f"recorded {names[0]},\nrecognised": [one for one, found in own if found == true],
            f"generated {names[0]}": [one for one in made if one.label == labels[true]],
            f"generated {names[1]}": [one for one in made if one.label == labels[taken]],
        }
        for group, (title, windows) in enumerate(groups.items()):
            shown = usual_windows(windows, SHARES)
            for place, column in enumerate(range(len(SHARES) * group, len(SHARES) * (group + 1))):
                upper, lower = axes[2 * row : 2 * row + 2, column]
                if place >= len(shown):  # nothing of this kind
                    upper.set_axis_off()
                    lower.set_axis_off()
                    continue
                _scatter(upper, lower, shown[place])
                upper.set_title(title, fontsize=8)
    axes[0, 0].set_xlim(0.0, seconds)
    axes[0, 0].set_ylim(-REACH_M, REACH_M)
    for row in range(len(pairs)):
        axes[2 * row, 0].set_ylabel("range, m", fontsize=8)
        axes[2 * row + 1, 0].set_ylabel("height, m", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("time, s", fontsize=8)
    colours = ScalarMappable(Normalize(-SHOWN_MPS, SHOWN_MPS), COLOURS)
    bar = figure.colorbar(colours, ax=axes, aspect=60, fraction=0.02, pad=0.01, extend="both")
    bar.set_label("radial velocity, m/s: blue approaches, red recedes; points at rest are grey", fontsize=8)
    bar.ax.tick_params(labelsize=8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png")


def _scatter(upper: "Axes", lower: "Axes", window: PointRecording) -> None:
    cloud = window.cloud
    range_m, moving = cloud.range_m, is_moving(cloud)
    middle = moving if moving.any() else ~moving
    time_s = cloud.frame / window.frame_rate_hz
    for axis, values in ((upper, range_m), (lower, cloud.z_m)):
        places = values - (np.median(values[middle]) if middle.any() else 0.0)
        axis.scatter(time_s[~moving], places[~moving], s=1, color="0.8", linewidths=0)
        axis.scatter(
            time_s[moving], places[moving], s=5, c=cloud.radial_velocity_mps[moving], cmap=COLOURS,
            vmin=-SHOWN_MPS, vmax=SHOWN_MPS, linewidths=0,
        )  # fmt: skip
