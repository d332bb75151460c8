"""Selection of the range bins that are kept: a window in metres or in bins, or all bins up to a size limit."""

import math
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig

MAX_CUBE_BYTES = 4 * 2**20  # cube size per frame without an explicit window
BYTES_A_CELL = 8  # complex64


def with_range(config: RadarConfig, near_m: float, far_m: float) -> RadarConfig:
    """Sets the range window in metres.

    Args:
        config: The radar.
        near_m: Near end in metres.
        far_m: Far end in metres.

    Returns:
        The radar with the range bins nearest to both ends and all bins between them.

    Raises:
        InputError: If the window is empty or exceeds the unambiguous range.
    """
    if not (math.isfinite(near_m) and math.isfinite(far_m) and 0 <= near_m < far_m):
        raise InputError(f"a range of {near_m:g} to {far_m:g} m is none; give near before far, for example 0.3,8")
    step_m = config.range_resolution_m
    if far_m > config.max_range_m + step_m / 2:
        raise InputError(
            f"radar {config.name!r} sees up to {config.max_range_m:.2f} m, not {far_m:g} m; range is ambiguous beyond"
        )
    first, last = round(near_m / step_m), round(far_m / step_m)
    return with_range_bins(config, first, min(last, config.num_unambiguous_range_bins - 1))


def with_range_bins(config: RadarConfig, first: int, last: int) -> RadarConfig:
    """Sets the range window in bins.

    Args:
        config: The radar.
        first: First bin that is kept.
        last: Last bin that is kept.

    Returns:
        The radar with that window.

    Raises:
        InputError: If the radar does not have these bins.
    """
    most = config.num_unambiguous_range_bins - 1
    if not 0 <= first <= last <= most:
        raise InputError(f"radar {config.name!r} has range bins 0 to {most}, not {first} to {last}")
    return replace(config, first_range_bin=first, num_range_bins=last - first + 1)


def default_range_bins(num_bins: int, cells_a_bin: int) -> int:
    """Number of nearest range bins that are kept by default.

    Args:
        num_bins: Range bins of the radar.
        cells_a_bin: Doppler bins times antennas.

    Returns:
        All of them, or as many as fit into a cube of 4 MiB per frame.

    >>> default_range_bins(256, 128 * 12), default_range_bins(512, 85 * 12)
    (256, 512)
    >>> default_range_bins(1024, 128 * 12)
    341
    """
    return max(1, min(num_bins, MAX_CUBE_BYTES // (BYTES_A_CELL * cells_a_bin)))


def chosen_range(
    config: RadarConfig, range_m: tuple[float, float] | None = None, range_bins: tuple[int, int] | None = None
) -> RadarConfig:
    """Sets the range window in metres or in bins, or keeps the radar's own.

    Args:
        config: The radar.
        range_m: (near, far) in metres. Default: not given.
        range_bins: (first, last), both kept. Default: not given.

    Returns:
        The radar with that window.

    Raises:
        InputError: If both are given, or the radar does not support the window.
    """
    if range_m is not None and range_bins is not None:
        raise InputError("give the range in metres or in bins, not both")
    if range_m is not None:
        return with_range(config, *range_m)
    return config if range_bins is None else with_range_bins(config, *range_bins)
