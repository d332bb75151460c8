"""How sensitive the board is, from recordings without labels: generated windows with as many points weigh more.

Noise, gain, threshold and cables of a board are unknown, and decide how many points it reports of a person. Generated
windows cover a wide range; their weights follow the density of the recorded number of points relative to the generated
one (importance weighting; Shimodaira, J. Stat. Planning and Inference 90, 2000).
"""

import numpy as np
from jaxtyping import Float

COUNTS = ("rate", "rest_rate")  # logarithms of moving points, and of resting points of the body, per frame
BINS = 6
MOST, LEAST = 5.0, 0.2  # of a ratio of densities
PSEUDO = 0.02  # share that every bin has at least


def sensitivity_weights(
    generated: Float[np.ndarray, "window feature"], recorded: Float[np.ndarray, "other feature"], names: tuple[str, ...]
) -> Float[np.ndarray, " window"]:
    """Weights (window,) of generated windows, mean 1."""
    weights = np.ones(len(generated))
    for name in COUNTS:
        made, real = generated[:, names.index(name)], recorded[:, names.index(name)]
        edges = np.unique(np.quantile(np.concatenate([made, real]), np.linspace(0, 1, BINS + 1)))[1:-1]
        place, there = np.searchsorted(edges, made), np.searchsorted(edges, real)
        of_made = np.bincount(place, minlength=BINS) / len(made) + PSEUDO
        of_real = np.bincount(there, minlength=BINS) / len(real) + PSEUDO
        weights *= np.clip(of_real / of_made, LEAST, MOST)[place]
    return weights / weights.mean()
