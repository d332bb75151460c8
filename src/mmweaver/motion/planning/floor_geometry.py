"""Geometry on the floor: directions, distances and random choices among positions (x, y) in metres."""

from typing import Any

import numpy as np
from jaxtyping import Float


def unit_vector(angle_rad: float) -> Float[np.ndarray, "2"]:
    """Unit vector (x, y) at an angle in radians from +x towards +y."""
    return np.array([np.cos(angle_rad), np.sin(angle_rad)])


def bearing_rad(vector: Any) -> float:
    """Angle of a vector (x, y) from +x towards +y, in radians."""
    return float(np.arctan2(vector[1], vector[0]))


def distance_m(one: Any, other: Any) -> float:
    """Distance between two positions (x, y), in metres."""
    return float(np.hypot(*(np.asarray(one) - np.asarray(other))))


def distances_m(positions: Float[np.ndarray, "position 2"], other: Any) -> Float[np.ndarray, " position"]:
    """Distance of each of many positions to another one.

    Args:
        positions: Positions (x, y) in metres, (position, 2).
        other: Position (x, y) in metres.

    Returns:
        Metres, (position,).
    """
    return np.hypot(*(positions - np.asarray(other)).T)


def random_sign(rng: np.random.Generator) -> float:
    """Samples -1 or 1."""
    return float(rng.choice([-1.0, 1.0]))


def random_choice(options: Any, rng: np.random.Generator) -> Any:
    """Samples one of a sequence, or of an array's rows, uniformly."""
    return options[int(rng.integers(len(options)))]
