"""An RGB-D photo with known gravity direction and floor, and the mapping between its pixels and the radar's frame."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.pinhole import project, unproject, viewing_rays
from mmweaver.core.records import RgbdPhoto, Scene
from mmweaver.core.shapes import Array, Rotation, Vec3


@dataclass(frozen=True, kw_only=True)
class ProjectedPoints:
    """Pixels onto which points project; all arrays have the leading shape of the points."""

    in_picture: Bool[Array, "*points"]
    row: Int[Array, "*points"]  # the nearest pixel's; 0 outside the picture
    column: Int[Array, "*points"]
    depth_m: Float[Array, "*points"]  # along the optical axis; negative behind the camera


@dataclass(frozen=True, kw_only=True)
class AlignedPhoto:
    """A photo aligned with gravity; the frame of a radar at the camera differs from the camera's by a rotation only.

    Attributes:
        photo: Colour, depth and intrinsics.
        radar_from_camera: Rotation from the camera frame (x right, y down, z forward) to x right, y away, z up.
        floor_z_m: Height of the floor in the radar's frame in metres; negative, since the floor is below the radar.
        camera_m: Position of the camera in the radar's frame in metres. Default: the origin.
    """

    photo: RgbdPhoto
    radar_from_camera: Rotation
    floor_z_m: float
    camera_m: Vec3 = field(default_factory=lambda: np.zeros(3))

    @classmethod
    def of(cls, scene: Scene) -> "AlignedPhoto":
        """Wraps the photo from which a scene was reconstructed.

        Args:
            scene: Scene with its photo, floor and radar pose.

        Returns:
            The photo in the frame of the scene's radar.
        """
        return cls(
            photo=scene.photo,
            radar_from_camera=scene.radar_from_camera,
            floor_z_m=scene.floor_z_m,
            camera_m=scene.radar_pose.seen(np.zeros(3)),
        )

    @cached_property
    def points_m(self) -> Float[Array, "height width 3"]:
        """Points measured by the pixels, in metres in the radar's frame; nan where depth is missing."""
        return unproject(self.photo.depth_m, self.photo.intrinsics) @ self.radar_from_camera.T + self.camera_m

    @cached_property
    def rays(self) -> Float[Array, "height width 3"]:
        """Viewing direction of every pixel in the radar's frame, scaled so that depth times ray is the point."""
        return viewing_rays(self.photo.intrinsics) @ self.radar_from_camera.T

    def project(self, points_m: Float[Array, "*points 3"]) -> tuple[Float[Array, "*points 2"], Float[Array, "*points"]]:
        """Projects points into the photo.

        Args:
            points_m: Points in the radar's frame, metres, (..., 3).

        Returns:
            Pixels (column, row), (..., 2), nan behind the camera; and depth along the optical axis in metres, (...,).
        """
        return project((points_m - self.camera_m) @ self.radar_from_camera, self.photo.intrinsics)

    def look_up(self, points_m: Float[Array, "*points 3"]) -> ProjectedPoints:
        """Finds the pixel nearest to the projection of each point.

        Args:
            points_m: Points in the radar's frame, metres, (..., 3).

        Returns:
            Row and column, depth, and whether the pixel lies inside the photo.
        """
        pixels, depth_m = self.project(points_m)
        rows, columns = self.photo.depth_m.shape
        nearest = np.nan_to_num(np.round(pixels), nan=-1.0).clip(-1, 1e6).astype(int)
        column, row = nearest[..., 0], nearest[..., 1]
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        return ProjectedPoints(
            in_picture=inside, row=np.where(inside, row, 0), column=np.where(inside, column, 0), depth_m=depth_m
        )
