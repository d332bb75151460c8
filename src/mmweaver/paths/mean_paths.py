"""What the network writes: echoes, before any radar has seen them."""

from dataclasses import dataclass

from torch import Tensor

from mmweaver.core.tensor_record import TensorRecord


@dataclass(frozen=True, kw_only=True)
class Echoes(TensorRecord):
    """Mean echoes (..., echo): cross sections in square metres, places in metres, m/s and direction cosines."""

    range_m: Tensor
    velocity_mps: Tensor
    direction: Tensor
    cross_section_m2: Tensor
