"""The records that packages exchange.

Frame of reference for every position: the radar's. x right, y away from the radar, z up (against gravity), metres,
origin at the radar. Radial velocity positive = moving away.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import AT_CAMERA, RadarPose
from mmweaver.core.record_display import ShownByFacts, span
from mmweaver.core.shapes import (
    AdcValues,
    AntennaPositions,
    ClassPixels,
    CubeValues,
    DepthPixels,
    Faces,
    GridMask,
    Joints,
    PerDoppler,
    PerFace,
    PerFrame,
    PerPoint,
    PerRange,
    RgbPixels,
    Rotation,
    Vec3,
    Vertices,
)


# Radar --------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class CubeGrid:
    """The axes of a RadarCube, one per dimension, in its order."""

    frame_time_s: PerFrame  # start of each frame
    range_m: PerRange
    radial_velocity_mps: PerDoppler
    antenna_position_m: AntennaPositions  # virtual antennas, tx + rx
    wavelength_m: float

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, first_frame: int = 0) -> "CubeGrid":
        """The grid of a radar's range and Doppler FFTs for a number of frames, counted from `first_frame`."""
        return cls(
            frame_time_s=np.arange(first_frame, first_frame + num_frames) * config.frame_period_s,
            range_m=config.range_m,
            radial_velocity_mps=config.radial_velocity_mps,
            antenna_position_m=config.antenna_position_m,
            wavelength_m=config.wavelength_m,
        )

    @property
    def shape(self) -> tuple[int, int, int, int]:
        return (len(self.frame_time_s), len(self.range_m), len(self.radial_velocity_mps), len(self.antenna_position_m))


@dataclass(frozen=True, kw_only=True, repr=False)
class AdcCube(ShownByFacts):
    """ADC samples: complex64 (frame, loop, tx, rx, sample).

    `tx` is the physical transmitter, not its place in the firing order. `scale` is the amplitude at the receiver's
    port, in sqrt(mW), of the value 1.0; nan where it is unknown (a recording). Real samples have zero imaginary parts.
    """

    samples: AdcValues
    config: RadarConfig
    scale: float

    def facts(self) -> dict[str, str]:
        """Sizes, type and radar."""
        names = ("frames", "loops", "transmitters", "receivers", "samples")
        sizes = {name: str(size) for name, size in zip(names, self.samples.shape, strict=True)}
        return {**sizes, "type": str(self.samples.dtype), "radar": self.config.name}


@dataclass(frozen=True, kw_only=True, repr=False)
class RadarCube(ShownByFacts):
    """Range-Doppler spectrum of every virtual antenna: complex64 (frame, range, doppler, antenna).

    The TDM phase is compensated, so antennas of a cell differ by their positions only. `scale` as in AdcCube.
    """

    values: CubeValues
    grid: CubeGrid
    config: RadarConfig
    scale: float

    def select(self, frames: slice | np.ndarray) -> "RadarCube":
        """Some of the frames, by slice or index."""
        grid = CubeGrid(
            frame_time_s=self.grid.frame_time_s[frames],
            range_m=self.grid.range_m,
            radial_velocity_mps=self.grid.radial_velocity_mps,
            antenna_position_m=self.grid.antenna_position_m,
            wavelength_m=self.grid.wavelength_m,
        )
        return RadarCube(values=self.values[frames], grid=grid, config=self.config, scale=self.scale)

    def facts(self) -> dict[str, str]:
        """Axes, type and radar."""
        return {
            "frames": span(self.grid.frame_time_s, "s"),
            "range": span(self.grid.range_m, "m"),
            "doppler": span(self.grid.radial_velocity_mps, "m/s"),
            "antennas": str(self.values.shape[3]),
            "type": str(self.values.dtype),
            "radar": self.config.name,
        }


@dataclass(frozen=True, kw_only=True, repr=False)
class PointCloud(ShownByFacts):
    """Detections of all frames, one row each."""

    frame: np.ndarray  # (point,) int, index of the frame
    x_m: PerPoint
    y_m: PerPoint
    z_m: PerPoint
    radial_velocity_mps: PerPoint
    snr_db: PerPoint

    @property
    def xyz_m(self) -> np.ndarray:
        """Places (point, 3)."""
        return np.stack([self.x_m, self.y_m, self.z_m], axis=1)

    @property
    def range_m(self) -> np.ndarray:
        """Distance of each point from the radar, (point,)."""
        return np.sqrt(self.x_m**2 + self.y_m**2 + self.z_m**2)

    def select(self, which: np.ndarray) -> "PointCloud":
        """The points selected by mask or index (point,)."""
        return PointCloud(**{field.name: getattr(self, field.name)[which] for field in fields(PointCloud)})

    def facts(self) -> dict[str, str]:
        """Number of points, and their bounds."""
        bounds = {"x": (self.x_m, "m"), "y": (self.y_m, "m"), "z": (self.z_m, "m")}
        bounds |= {"velocity": (self.radial_velocity_mps, "m/s"), "SNR": (self.snr_db, "dB")}
        return {
            "points": str(len(self.frame)),
            "frames": str(len(np.unique(self.frame))),
            **{name: _bounds(values, unit) for name, (values, unit) in bounds.items()},
        }


# Motion -------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True, repr=False)
class PoseSequence(ShownByFacts):
    """Joints of one person at given times, in the radar's frame; SMPL order, see core.skeleton.

    Motions are sampled densely (100 Hz and more), so that slow time can be interpolated; results hold a sequence
    resampled at the radar's frames.
    """

    time_s: PerFrame
    joints_m: Joints
    height_m: float
    subject: int = 0  # identifies the body: its surface points and random phases
    girth: float = 1.0  # thickness of trunk and limbs relative to the average body of this height

    def facts(self) -> dict[str, str]:
        """Times, joints and body."""
        return {
            "frames": span(self.time_s, "s"),
            "joints": str(self.joints_m.shape[1]),
            "height": f"{self.height_m:.2f} m",
            "subject": str(self.subject),
        }


# Scene --------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class CameraIntrinsics:
    """A pinhole camera, in pixels of its picture; pixel centres are at whole numbers."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int


@dataclass(frozen=True, kw_only=True)
class ClassMask:
    """The class of each pixel, with names of COCO-Stuff ("couch", "wall-concrete")."""

    index: ClassPixels  # into `names`; 0 = unknown
    names: tuple[str, ...]  # names[0] is "unlabeled"


@dataclass(frozen=True, kw_only=True, repr=False)
class RgbdPhoto(ShownByFacts):
    """A colour picture and its depth along the optical axis in metres; nan = no measurement."""

    rgb: RgbPixels
    depth_m: DepthPixels
    intrinsics: CameraIntrinsics
    classes: ClassMask | None = None  # given by the user or by a segmenter

    def facts(self) -> dict[str, str]:
        """Size, share of pixels with a depth, number of classes."""
        height, width = self.depth_m.shape
        return {
            "size": f"{width} x {height} pixels",
            "with depth": f"{100 * np.isfinite(self.depth_m).mean():.0f} %",
            "classes": "none" if self.classes is None else str(len(self.classes.names)),
        }


@dataclass(frozen=True, kw_only=True)
class Plane:
    """A planar rectangle of the room. axis_u, axis_v and normal are a right-handed orthonormal triple."""

    kind: str  # floor | ceiling | wall | top | panel
    centre_m: Vec3
    normal: Vec3  # towards the free side
    axis_u: Vec3
    axis_v: Vec3
    half_size_m: tuple[float, float]  # along axis_u, axis_v
    material: str

    @property
    def area_m2(self) -> float:
        return 4 * self.half_size_m[0] * self.half_size_m[1]

    @property
    def corners_m(self) -> np.ndarray:
        """(4, 3), counterclockwise seen from the free side."""
        u, v = self.half_size_m[0] * self.axis_u, self.half_size_m[1] * self.axis_v
        return np.stack([self.centre_m - u - v, self.centre_m + u - v, self.centre_m + u + v, self.centre_m - u + v])

    def spanned(self, low_m: np.ndarray | tuple[float, float], high_m: np.ndarray | tuple[float, float]) -> "Plane":
        """The rectangle from `low_m` to `high_m`, (2,) along axis_u and axis_v, from this one's centre."""
        (left, below), (right, above) = low_m, high_m
        centre_m = self.centre_m + (left + right) / 2 * self.axis_u + (below + above) / 2 * self.axis_v
        return replace(self, centre_m=centre_m, half_size_m=(float(right - left) / 2, float(above - below) / 2))

    def moved(self, points: Callable[[Vec3], Vec3], directions: Callable[[Vec3], Vec3]) -> "Plane":
        """The rectangle in another frame, by what moves its points and what turns its directions."""
        return replace(
            self,
            centre_m=points(self.centre_m),
            normal=directions(self.normal),
            axis_u=directions(self.axis_u),
            axis_v=directions(self.axis_v),
        )


@dataclass(frozen=True, kw_only=True)
class FreeSpace:
    """The places of the floor where a body may stand, on a square grid."""

    x_m: np.ndarray  # (x,) centres of the columns
    y_m: np.ndarray  # (y,) centres of the rows
    is_free: GridMask  # free from the floor to head height
    is_seen: GridMask  # measured; a free cell that is not seen is assumed to be free
    is_assumed: GridMask | None = None  # probably free, though not seen to be: the last resort for a motion


@dataclass(frozen=True, kw_only=True)
class Seat:
    """A horizontal surface at seat height."""

    position_m: Vec3  # middle of the seat, on the surface
    facing_rad: float  # of the sitter, from +x (right) towards +y (away from the radar)
    size_m: tuple[float, float]  # across and along the facing


LANDMARK_KINDS = (
    "door",
    "window",
    "table",
    "counter",
    "bed",
    "wall",
    "desk",
    "shelf",
    "fridge",
    "tv",
    "wardrobe",
    "sink",
    "plant",
    "lamp",
    "stove",
    "cabinet",
    "couch",
    "chair",
)


@dataclass(frozen=True, kw_only=True)
class Landmark:
    """An object that a sentence may name as a place to go to."""

    kind: str  # one of LANDMARK_KINDS; in a photo door | window | table | counter | bed are found
    position_m: Vec3  # its middle
    approach_m: tuple[float, float]  # (x, y) where one stands to use it
    facing_rad: float  # of a person there, from +x (right) towards +y (away from the radar)


@dataclass(frozen=True, kw_only=True, repr=False)
class Scene(ShownByFacts):
    """A room, reconstructed from a photo or procedural, for ray casting and motion planning; in the radar's frame."""

    photo: RgbdPhoto
    radar_from_camera: Rotation  # camera x right, y down, z forward -> radar frame
    vertices_m: Vertices
    faces: Faces
    face_material: PerFace  # index into material_names
    material_names: tuple[str, ...]
    planes: tuple[Plane, ...]  # including the floor
    floor_z_m: float  # below the radar, so negative
    free_space: FreeSpace
    seats: tuple[Seat, ...]
    assumptions: tuple[str, ...]  # sentences for meta.json
    landmarks: tuple[Landmark, ...] = ()
    radar_pose: RadarPose = AT_CAMERA  # of the radar whose frame this is; the photo is always the camera's

    def facts(self) -> dict[str, str]:
        """Sizes, planes, seats and landmarks."""
        return {
            "vertices": str(len(self.vertices_m)),
            "planes": _counted([plane.kind for plane in self.planes]),
            "floor": f"{self.floor_z_m:.2f} m",
            "seats": str(len(self.seats)),
            "landmarks": _counted([landmark.kind for landmark in self.landmarks]),
        }

    @property
    def floor(self) -> Plane:
        return next(plane for plane in self.planes if plane.kind == "floor")


def _counted(kinds: list[str]) -> str:
    """The counts of kinds as a string: "floor, 3 wall" for ["wall", "floor", "wall", "wall"]."""
    counts = {kind: kinds.count(kind) for kind in sorted(set(kinds))}
    return ", ".join(kind if count == 1 else f"{count} {kind}" for kind, count in counts.items()) or "none"


def _bounds(values: np.ndarray, unit: str) -> str:
    return f"{values.min():.2f} to {values.max():.2f} {unit}" if len(values) else "none"
