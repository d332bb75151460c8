"""Noise model of a stereo depth camera such as the RealSense D455."""

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array, DepthPixels

BASELINE_M = 0.095  # of the D455
_STEP_PX, _NOISE_PX = 1 / 32, 0.06
_NEAREST_M, _FARTHEST_M = 0.4, 8.0
_GRAZING = 0.12  # cosine below which surfaces are often lost


def measured_depth(
    depth_m: DepthPixels,
    focal_px: float,
    is_glass: Bool[Array, "height width"],
    cos_view: Float[Array, "height width"],
    seed: int,
) -> DepthPixels:
    """Simulates a stereo measurement: noise and quantization of the disparity, and holes.

    Holes are occlusions of the second camera, glass, surfaces seen at grazing angles, speckles, and depths outside 0.4
    to 8 m.

    Args:
        depth_m: True depth in metres, (height, width).
        focal_px: Focal length in pixels.
        is_glass: Pixels of glass, (height, width).
        cos_view: Cosine between ray and surface normal, (height, width).
        seed: Seed of the noise.

    Returns:
        Measured depth in metres, (height, width), nan in holes.
    """
    rng = stream(seed, "procedural", "depth")
    height, width = depth_m.shape
    blocks = (-(-height // 4), -(-width // 4))
    baseline = BASELINE_M * focal_px
    disparity = baseline / depth_m
    coarse = np.kron(rng.normal(0, _NOISE_PX, blocks), np.ones((4, 4)))[:height, :width]
    disparity = disparity + coarse + rng.normal(0, _NOISE_PX / 3, depth_m.shape)
    disparity = np.round(disparity / _STEP_PX) * _STEP_PX
    measured = baseline / np.maximum(disparity, _STEP_PX)
    lost = _occluded(baseline / depth_m) | (measured < _NEAREST_M) | (measured > _FARTHEST_M)
    lost |= np.kron(rng.random(blocks) < 0.002, np.ones((4, 4), bool))[:height, :width]
    lost |= (cos_view < _GRAZING) & (np.kron(rng.random(blocks), np.ones((4, 4)))[:height, :width] < 0.5)
    lost |= is_glass & (np.kron(rng.random(blocks), np.ones((4, 4)))[:height, :width] < 0.85)
    return np.where(lost, np.nan, measured)


def _occluded(disparity: Float[Array, "height width"]) -> Bool[Array, "height width"]:
    """Pixels occluded in the second camera: a strip left of near objects, as wide as the step in disparity."""
    occluded = np.zeros_like(disparity, dtype=bool)
    jump = disparity[:, 1:] - disparity[:, :-1]
    last = occluded.shape[-1] - 1
    for columns in range(1, 24):
        near = jump[:, columns - 1 :] > max(columns, 1.5)
        occluded[:, : last - columns + 1] |= near
    return occluded
