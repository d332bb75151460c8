"""A further photo of a room and where its camera stood."""

from dataclasses import dataclass

from jaxtyping import Float

from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array

Pose = Float[Array, "4 4"]


@dataclass(frozen=True, kw_only=True)
class PosedPhoto:
    """A photo with its camera's pose relative to that of the room's first photo.

    `pose` moves points of this camera (x right, y down, z forward) into the first camera's, metres. A `RadarPose` says
    roughly where the camera stood and how far it was turned, in the first camera's level frame; the photos' own
    floors and walls then say the rest.
    """

    photo: RgbdPhoto
    pose: Pose | RadarPose

    @property
    def is_rough(self) -> bool:
        """Whether only place and turn are known, and these roughly."""
        return isinstance(self.pose, RadarPose)
