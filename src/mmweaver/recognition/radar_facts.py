"""What a task says of its radar, as far as points show it: steps of range and velocity, what firmware leaves out."""

from dataclasses import asdict, dataclass

import numpy as np

from mmweaver.dsp.firmware import range_step_m
from mmweaver.recognition.task_file import RecognitionTask


@dataclass(frozen=True, kw_only=True)
class RadarFacts:
    """What a task says of the radar, as its points show it."""

    range_step_m: float
    velocity_step_mps: float
    max_velocity_mps: float
    removes_static: bool
    groups_range: bool  # of neighbours in range or in velocity one is reported
    groups_velocity: bool
    knows_place: bool  # whether there is a recording of the empty place

    @staticmethod
    def of(task: RecognitionTask) -> "RadarFacts":
        """Those of a task."""
        radar = task.radar
        return RadarFacts(
            range_step_m=range_step_m(radar), velocity_step_mps=radar.velocity_resolution_mps,
            max_velocity_mps=radar.max_velocity_mps, removes_static=task.firmware.static_removal,
            groups_range=task.firmware.group_range, groups_velocity=task.firmware.group_doppler,
            knows_place=task.background is not None,
        )  # fmt: skip

    @staticmethod
    def read(values: object) -> "RadarFacts | None":
        """Those of `values`; None where it holds none, as models of before."""
        try:
            found = RadarFacts(**values) if isinstance(values, dict) else None
            if found is None or not 0 < found.velocity_step_mps <= found.max_velocity_mps < np.inf:
                return None
            return found if 0 < found.range_step_m < np.inf else None
        except TypeError:
            return None

    def values(self) -> dict[str, float | bool]:
        """For meta.json."""
        return asdict(self)
