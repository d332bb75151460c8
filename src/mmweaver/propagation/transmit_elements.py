"""Simultaneous transmission as a sum over elements: one element is one transmitter in one chirp of the loop.

Code that computes TDM-MIMO signals computes those of the elements, which share the times of the chirps; the elements
of a slot are then summed with their weights.
Reference: `core.transmit_code`.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.transmit_code import weights_of


@dataclass(frozen=True, kw_only=True)
class ElementRadar(RadarConfig):
    """A radar whose transmitters are the elements of a coded one; several of them share a slot."""

    slot: tuple[int, ...] = ()  # per element
    slots: int = 1  # per loop

    @property
    def loop_period_s(self) -> float:
        """Duration of a loop in seconds."""
        return self.slots * self.chirp_period_s + self.loop_gap_s

    @cached_property
    def tx_delay_s(self) -> np.ndarray:
        """Start of each element's chirp within the loop, (element,), in seconds."""
        return np.asarray(self.slot) * self.chirp_period_s


class TransmitElements:
    """The elements of a radar, and the conversion of their signals. Those of a TDM radar are its transmitters."""

    def __init__(self, config: RadarConfig):
        """Derives the elements.

        Args:
            config: The radar, with or without a transmit code.
        """
        self.is_coded = config.is_coded
        self.config = config
        if not self.is_coded:
            return
        weights = weights_of(config.tx_code)
        slot, tx = np.nonzero(weights)
        values = {name: getattr(config, name) for name in RadarConfig.__dataclass_fields__}
        values |= {
            "tx_code": (),
            "tx_order": tuple(range(len(tx))),
            "tx_position_m": tuple(config.tx_position_m[index] for index in tx),
        }
        self.config = ElementRadar(**values, slot=tuple(slot.tolist()), slots=config.num_slots)
        self._tx = torch.from_numpy(tx)
        into = np.zeros((config.num_slots, len(tx)), complex)
        into[slot, np.arange(len(tx))] = weights[slot, tx]
        self._into_slots = torch.from_numpy(into).to(torch.complex64)
        self._into_tx = torch.from_numpy(config.tx_decoder @ into).to(torch.complex64)

    def lengths(self, length_m: Tensor) -> Tensor:
        """Path lengths (path, tx, rx) of physical transmitters to those of elements (path, element, rx)."""
        return length_m[:, self._tx] if self.is_coded else length_m

    def slots(self, samples: Tensor, axis: int) -> Tensor:
        """Sums the elements into slots.

        Args:
            samples: Values of elements on one axis.
            axis: That axis.

        Returns:
            Values of slots on that axis, complex64 for a coded radar.
        """
        return _summed(self._into_slots, samples, axis) if self.is_coded else samples

    def decoded(self, values: Tensor) -> Tensor:
        """Separates the transmitters of a coded radar.

        Args:
            values: Values (..., element * rx), each compensated for the delay of its slot.

        Returns:
            Values (..., antenna).
        """
        if not self.is_coded:
            return values
        apart = values.unflatten(-1, (len(self._tx), -1))
        return _summed(self._into_tx, apart, -2).flatten(-2)

    def pair_values(self, values: Tensor) -> Tensor:
        """Values (..., tx, rx) of physical transmitters to those of elements (..., element, rx)."""
        return values[..., self._tx, :] if self.is_coded else values

    def mixing(self, channels: Tensor) -> Tensor:
        """Antenna errors of physical antennas (tx * rx, tx * rx) to those of elements (element * rx, element * rx).

        All elements of a transmitter see the same wave, so its contribution is taken from the first one.
        """
        if not self.is_coded:
            return channels
        num_tx, rx = len(self._tx.unique()), self.config.num_rx
        apart = channels.reshape(num_tx, rx, num_tx, rx)
        mixed = channels.new_zeros(len(self._tx), rx, len(self._tx), rx)
        for transmitter in range(num_tx):
            first = int((self._tx == transmitter).nonzero()[0, 0])
            mixed[:, :, first] = apart[self._tx][:, :, transmitter]
        return mixed.flatten(2).flatten(0, 1)


def _summed(matrix: Tensor, values: Tensor, axis: int) -> Tensor:
    moved = values.movedim(axis, 0)
    return torch.tensordot(matrix.to(values.device), moved.to(torch.complex64), dims=1).movedim(0, axis)
