"""Output of the networks: mean echoes, independent of the radar, before phases are sampled (`speckle`)."""

from dataclasses import dataclass

from torch import Tensor

from mmweaver.core.tensor_record import TensorRecord


@dataclass(frozen=True, kw_only=True)
class MeanEchoes(TensorRecord):
    """Echoes of scatterers, averaged over their unknown phases."""

    range_m: Tensor  # (..., echo)
    velocity_mps: Tensor  # (..., echo) radial, positive away from the radar
    direction: Tensor  # (..., echo, 2) direction cosines along x and z
    cross_section_m2: Tensor  # (..., echo) mean
