"""Expected power maps from stored geometry: training targets without speckle and noise fluctuation.

A simulated signal is one random realization in every cell; the simulator's paths give its mean directly.
Reference: docs/decisions/loss-on-mean-power.md.
"""

from dataclasses import fields

import numpy as np

from mmweaver.datasets.dataset_store import StoredRoom
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.image_sources import moving_points, static_points
from mmweaver.propagation.mean_power import MeanPower, PowerMaps


class ExpectedMaps:
    """Mean power maps of one room of a data set with geometry."""

    def __init__(self, room: StoredRoom):
        """Computes the maps of the static room.

        Args:
            room: Room with geometry.
        """
        assert room.geometry is not None, "signals are stored, not geometry"
        self.room, self.radar = room, _radar(room)
        self.static = self.radar.maps(static_points(room.geometry.room.paths, self.radar.response))

    def frames(self, index: int, frames: np.ndarray) -> tuple[PowerMaps, PowerMaps]:
        """Computes maps of frames of a sequence.

        Args:
            index: Index of the sequence.
            frames: Indices of frames.

        Returns:
            Power maps (frame, range, other) of room, person and noise together, and of the person only.
        """
        person = self.room.body_paths(index, frames)
        both = [self._frame(person, number) for number in range(len(frames))]
        return PowerMaps.stack([whole for whole, _ in both]), PowerMaps.stack([alone for _, alone in both])

    def _frame(self, person: BodyPaths, number: int) -> tuple[PowerMaps, PowerMaps]:
        response = self.radar.response
        segments = person.paths(number)
        moving = self.radar.maps(moving_points(segments[len(segments) // 2], response))
        occluded = self.radar.maps(static_points(person.occluded_paths(number), response))
        names = [field.name for field in fields(PowerMaps)]
        maps = {}
        for name, noise in zip(names, self.radar.noise_maps(), strict=True):
            static = getattr(self.static, name)
            visible = (static - getattr(occluded, name)).clamp(min=0)
            maps[name] = visible + getattr(moving, name) + noise
        return PowerMaps(**maps), moving


_RADARS: dict[str, MeanPower] = {}


def _radar(room: StoredRoom) -> MeanPower:
    """The radar, shared by all rooms of the same configuration."""
    key = room.config.to_json()
    if key not in _RADARS:
        _RADARS[key] = MeanPower(room.config)
    return _RADARS[key]
