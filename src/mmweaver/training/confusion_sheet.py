"""Confusion matrix of a classifier as a picture."""

import numpy as np

from mmweaver.training.validation_sheet import canvas_image


def draw_confusion(true: np.ndarray, answers: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Image (row, column, 3) uint8 of the row-normalised confusion matrix; `true` and `answers` (n,) are indices."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    share = confusion(true, answers, len(names))
    figure = Figure(figsize=(7.0, 6.2), layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots()
    image = axes.imshow(share, cmap="Blues", vmin=0, vmax=1)
    for row, column in zip(*np.nonzero(share >= 0.005), strict=True):
        ink = "white" if share[row, column] > 0.6 else "black"
        axes.text(column, row, f"{100 * share[row, column]:.0f}", ha="center", va="center", color=ink, fontsize=8)
    axes.set_xticks(range(len(names)), names, rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(names)), names, fontsize=8)
    axes.set_xlabel("predicted")
    axes.set_ylabel("true")
    axes.set_title(f"{100 * float((true == answers).mean()):.1f} % of {len(true)} correct", fontsize=10)
    figure.colorbar(image, ax=axes, shrink=0.8).set_label("share of the true class", fontsize=8)
    return canvas_image(canvas)


def confusion(true: np.ndarray, answers: np.ndarray, count: int) -> np.ndarray:
    """Row-normalised confusion matrix (true, predicted); rows of absent classes are zero."""
    counts = np.zeros((count, count))
    np.add.at(counts, (true, answers), 1)
    return counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
