"""Position and orientation of a radar in a room: a rigid motion from the camera's level frame to the radar's."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Rotation

MAX_PLACE_M = 100.0
MAX_RADARS = 8


@dataclass(frozen=True, kw_only=True)
class RadarPose:
    """Pose of a radar in the camera's level frame: x right, y away from the camera, z up, origin at the camera.

    `yaw_deg` turns the boresight to the right, `pitch_deg` raises it, and `roll_deg` then tilts the radar to its right
    about the boresight (90: vertical radar of HuPR). The default pose is level, at the camera.

    Raises:
        InputError: If a number is not finite or outside its limits.
    """

    x_m: float = 0.0
    y_m: float = 0.0
    z_m: float = 0.0
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0
    roll_deg: float = 0.0

    def __post_init__(self) -> None:
        limits = {
            **dict.fromkeys(("x_m", "y_m", "z_m"), MAX_PLACE_M),
            "yaw_deg": 360,
            "pitch_deg": 90,
            "roll_deg": 180,
        }
        for name, limit in limits.items():
            value = getattr(self, name)
            if not (math.isfinite(value) and abs(value) <= limit):
                raise InputError(f"a radar's {name} must be from {-limit:g} to {limit:g}, not {value:g}")

    @classmethod
    def of_words(cls, words: str) -> "RadarPose":
        """Parses a pose.

        Args:
            words: "x,y,z,yaw,pitch" or "x,y,z,yaw,pitch,roll" in metres and degrees.

        Returns:
            The pose.

        Raises:
            InputError: If the text does not parse or is outside the limits.
        """
        try:
            values = [float(word) for word in words.split(",")]
        except ValueError:
            values = []
        if len(values) not in (5, 6):
            raise InputError(
                f"{words[:60]!r} is no place of a radar; write x,y,z,yaw,pitch in metres and degrees, for example"
                " 0.5,0,0.2,-30,10"
            )
        names = ("x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg")
        return cls(**dict(zip(names, values, strict=False)))

    @property
    def words(self) -> str:
        """The pose in the format of `of_words`.

        >>> RadarPose(x_m=0.5, yaw_deg=-30.0).words
        '0.5,0,0,-30,0,0'
        """
        values = (self.x_m, self.y_m, self.z_m, self.yaw_deg, self.pitch_deg, self.roll_deg)
        return ",".join(repr(float(value)).removesuffix(".0") for value in values)

    @property
    def is_at_camera(self) -> bool:
        """Whether this is the default pose, level at the camera."""
        return self == RadarPose()

    @property
    def position_m(self) -> np.ndarray:
        """Position in the camera's level frame in metres, (3,)."""
        return np.array([self.x_m, self.y_m, self.z_m], float)

    @property
    def from_level(self) -> Rotation:
        """Rotation from the camera's level frame to the radar's, (3, 3); rows are right, boresight and up."""
        yaw, pitch, roll = np.radians([self.yaw_deg, self.pitch_deg, self.roll_deg])
        boresight = np.array([np.sin(yaw) * np.cos(pitch), np.cos(yaw) * np.cos(pitch), np.sin(pitch)])
        level_right = np.array([np.cos(yaw), -np.sin(yaw), 0.0])
        up = np.cross(level_right, boresight)
        right = np.cos(roll) * level_right - np.sin(roll) * up
        return np.stack([right, boresight, np.cross(right, boresight)])

    def seen(self, points_m: Any) -> np.ndarray:
        """Transforms points to the radar's frame.

        Args:
            points_m: Points in the camera's level frame, metres, (..., 3).

        Returns:
            Points in the radar's frame, metres, (..., 3).
        """
        if self.is_at_camera:
            return np.asarray(points_m)
        return (np.asarray(points_m) - self.position_m) @ self.from_level.T

    def seen_directions(self, vectors: Any) -> np.ndarray:
        """Rotates directions to the radar's frame.

        Args:
            vectors: Directions in the camera's level frame, (..., 3).

        Returns:
            Directions in the radar's frame, (..., 3).
        """
        return np.asarray(vectors) @ self.from_level.T

    def in_level_frame(self, points_m: Any) -> np.ndarray:
        """Transforms points to the camera's level frame; inverse of `seen`.

        Args:
            points_m: Points in the radar's frame, metres, (..., 3).

        Returns:
            Points in the camera's level frame, metres, (..., 3).
        """
        if self.is_at_camera:
            return np.asarray(points_m)
        return np.asarray(points_m) @ self.from_level + self.position_m

    def noise_seed(self, seed: int) -> int:
        """Seed of this radar's noise, which is independent between the radars of one scene.

        Args:
            seed: Seed of the run.

        Returns:
            `seed` itself for the default pose, otherwise derived from seed and pose.
        """
        return seed if self.is_at_camera else int(stream(seed, "radar", self.words).integers(2**62))


AT_CAMERA = RadarPose()


def check_poses(poses: tuple[RadarPose, ...]) -> None:
    """Checks the poses of all radars of a scene.

    Args:
        poses: One pose per radar.

    Raises:
        InputError: If there are too many, or two are equal.
    """
    if len(poses) > MAX_RADARS:
        raise InputError(f"give at most {MAX_RADARS} radars, not {len(poses)}")
    if len(set(poses)) < len(poses):
        raise InputError("two radars stand at the same place and look the same way; move one of them")
