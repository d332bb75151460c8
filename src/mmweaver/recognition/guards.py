"""Guards: what is removed from the points of a window before features are computed, and how much of each recording.

A guard removes points only with evidence that they are not the subject: the empty place was recorded (`background`),
something else walks at the same time (`persistent`), a nearer group moves at the same time (`multipath`), an adjacent
cell holds the same echo (`neighbours`), or no radar can have measured the velocity (`impossible`). Each can be switched
off.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool

from mmweaver.core.errors import InputError
from mmweaver.recognition.background_mask import NO_CELLS, Cells, moves_inside
from mmweaver.recognition.point_recordings import PointRecording, index_runs, is_moving
from mmweaver.recognition.quantisation import Quantisation, is_flank

IMPOSSIBLE_MPS = 100.0  # no chirp of these boards measures it without ambiguity: the value is damaged
AT_ONCE_S = 0.15
MULTIPATH_GROUP_M = 0.8  # distance within which points belong to the same group
MULTIPATH_APART_M, MULTIPATH_BEHIND_M = 1.0, 0.6  # minimum distance and range difference of person and multipath
MIN_NEARER, NEARER_SHARE = 2, 0.5  # points of the nearer group: minimum number, and share of the farther group

Mask = Bool[np.ndarray, " point"]


@dataclass(frozen=True, kw_only=True, eq=False)
class WindowFilter:
    """Guards of a recogniser, applied to all windows, generated and recorded."""

    background: Cells = field(default_factory=NO_CELLS.copy)  # moving points in these cells are removed
    persistent: Cells = field(default_factory=NO_CELLS.copy)  # likewise
    radar: Quantisation | None = None  # of the task; None for models before 0.3, which kept neighbours and multipath
    off: frozenset[str] = frozenset()  # guards that are switched off

    def without(self, names: frozenset[str]) -> "WindowFilter":
        """The filter with further guards switched off."""
        return replace(self, off=self.off | names) if names else self

    def __call__(self, window: PointRecording) -> PointRecording:
        """The window without the removed points."""
        hidden = np.zeros(len(window.cloud.frame), bool)
        for mask in self.removed(window).values():
            hidden |= mask
        return replace(window, cloud=window.cloud.select(~hidden)) if hidden.any() else window

    def removed(self, recording: PointRecording) -> dict[str, Mask]:
        """Mask (point,) of the points that each guard removes, one after the other; guards without any are left out."""
        left, found = np.arange(len(recording.cloud.frame)), dict[str, Mask]()
        for name, guard in GUARDS.items():
            if name in self.off:
                continue
            hidden = guard(self, replace(recording, cloud=recording.cloud.select(left)))
            if hidden.any():
                found[name] = np.isin(np.arange(len(recording.cloud.frame)), left[hidden])
                left = left[~hidden]
        return found


def is_multipath(window: PointRecording) -> Mask:
    """Mask (point,) of moving points behind a nearer group that moves at the same time.

    Multipath of a person over a wall or another body is always longer than the direct path, so of two groups that move
    at the same time the nearer one is the person.

    Args:
        window: Points of one window.
    """
    cloud = window.cloud
    moving = np.flatnonzero(is_moving(cloud))
    frame, range_m = cloud.frame[moving], cloud.range_m[moving]
    place_m = np.stack([cloud.x_m, cloud.y_m], axis=1)[moving]
    lag = max(int(AT_ONCE_S * window.frame_rate_hz), 1)
    one, other = index_runs(np.searchsorted(frame, frame - lag), np.searchsorted(frame, frame + lag, side="right"))
    apart_m = np.hypot(*(place_m[one] - place_m[other]).T)
    group = np.bincount(one, apart_m < MULTIPATH_GROUP_M, minlength=len(frame))
    nearer = np.bincount(
        one, (apart_m > MULTIPATH_APART_M) & (range_m[other] < range_m[one] - MULTIPATH_BEHIND_M), minlength=len(frame)
    )
    hidden = np.zeros(len(cloud.frame), bool)
    hidden[moving[(nearer >= MIN_NEARER) & (nearer >= NEARER_SHARE * group)]] = True
    return hidden


def is_impossible(window: PointRecording) -> Mask:
    """Mask (point,) of velocities that no radar can have measured.

    Args:
        window: Points of a window or recording.
    """
    return np.abs(window.cloud.radial_velocity_mps) > IMPOSSIBLE_MPS


def _none(window: PointRecording) -> Mask:
    return np.zeros(len(window.cloud.frame), bool)


GUARDS: dict[str, Callable[[WindowFilter, PointRecording], Mask]] = {  # in their order
    "impossible": lambda own, window: is_impossible(window),
    "background": lambda own, window: moves_inside(window, own.background),
    "persistent": lambda own, window: moves_inside(window, own.persistent),
    "neighbours": lambda own, window: _none(window) if own.radar is None else is_flank(window, own.radar),
    "multipath": lambda own, window: _none(window) if own.radar is None else is_multipath(window),
}


def guard_names(text: str) -> frozenset[str]:
    """Names of guards, separated by commas.

    Args:
        text: As in `recognise --without`; "all" stands for every guard.

    Raises:
        InputError: If a name is unknown.
    """
    names = frozenset(GUARDS) if text == "all" else frozenset(filter(None, map(str.strip, text.split(","))))
    if unknown := sorted(names - set(GUARDS)):
        raise InputError(f"unknown guard {unknown[0]!r}; known: {', '.join(GUARDS)}, all")
    return names
