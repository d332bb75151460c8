"""A further photo of a room and its camera's pose."""

from dataclasses import dataclass

from jaxtyping import Float

from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array

Pose = Float[Array, "4 4"]


@dataclass(frozen=True, kw_only=True)
class PosedPhoto:
    """A photo with its camera's pose relative to that of the room's first photo.

    `pose` transforms points of this camera (x right, y down, z forward) into the first camera's, metres. A `RadarPose`
    is a rough position and yaw in the first camera's level frame, which the photos' own floors and walls refine.
    """

    photo: RgbdPhoto
    pose: Pose | RadarPose

    @property
    def is_rough(self) -> bool:
        """Whether only position and yaw are known, and those roughly."""
        return isinstance(self.pose, RadarPose)
