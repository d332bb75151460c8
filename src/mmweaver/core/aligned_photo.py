"""An RGB-D photo whose gravity direction and floor are known: its pixels as points of the radar's frame, and back."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.pinhole import project, unproject, viewing_rays
from mmweaver.core.records import RgbdPhoto, Scene
from mmweaver.core.shapes import Array, Rotation, Vec3


@dataclass(frozen=True, kw_only=True)
class ProjectedPoints:
    """Where points appear in a photo; shapes are those of the points."""

    in_picture: Bool[Array, "*points"]
    row: Int[Array, "*points"]  # the nearest pixel's; 0 outside the picture
    column: Int[Array, "*points"]
    depth_m: Float[Array, "*points"]  # along the optical axis; negative behind the camera


@dataclass(frozen=True, kw_only=True)
class AlignedPhoto:
    """A photo aligned with gravity. A radar at the camera differs from it by a rotation alone."""

    photo: RgbdPhoto
    radar_from_camera: Rotation  # camera x right, y down, z forward -> radar x right, y away, z up
    floor_z_m: float  # below the radar, so negative
    camera_m: Vec3 = field(default_factory=lambda: np.zeros(3))  # where the camera stands, in the radar's frame

    @classmethod
    def of(cls, scene: Scene) -> "AlignedPhoto":
        """The photo that a scene was reconstructed from."""
        return cls(
            photo=scene.photo,
            radar_from_camera=scene.radar_from_camera,
            floor_z_m=scene.floor_z_m,
            camera_m=scene.radar_pose.seen(np.zeros(3)),
        )

    @cached_property
    def points_m(self) -> Float[Array, "height width 3"]:
        """The measured point of every pixel, metres, radar's frame; nan where nothing was measured."""
        return unproject(self.photo.depth_m, self.photo.intrinsics) @ self.radar_from_camera.T + self.camera_m

    @cached_property
    def rays(self) -> Float[Array, "height width 3"]:
        """The viewing direction of every pixel in the radar's frame, scaled to a depth of 1."""
        return viewing_rays(self.photo.intrinsics) @ self.radar_from_camera.T

    def project(self, points_m: Float[Array, "*points 3"]) -> tuple[Float[Array, "*points 2"], Float[Array, "*points"]]:
        """Pixels (column, row) and depth in metres of points of the radar's frame; nan pixels behind the camera."""
        return project((points_m - self.camera_m) @ self.radar_from_camera, self.photo.intrinsics)

    def look_up(self, points_m: Float[Array, "*points 3"]) -> ProjectedPoints:
        """The pixel nearest to each point of the radar's frame."""
        pixels, depth_m = self.project(points_m)
        rows, columns = self.photo.depth_m.shape
        nearest = np.nan_to_num(np.round(pixels), nan=-1.0).clip(-1, 1e6).astype(int)
        column, row = nearest[..., 0], nearest[..., 1]
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        return ProjectedPoints(
            in_picture=inside, row=np.where(inside, row, 0), column=np.where(inside, column, 0), depth_m=depth_m
        )
