"""The records that packages exchange.

Frame of reference for every position: the radar's. x right, y away from the radar, z up (against gravity), metres,
origin at the radar. Radial velocity positive = moving away.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.radar_config import RadarConfig
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
    """The axes of a RadarCube, one per dimension, in the cube's order."""

    frame_time_s: PerFrame  # start of each frame
    range_m: PerRange
    radial_velocity_mps: PerDoppler
    antenna_position_m: AntennaPositions  # virtual antennas, tx + rx
    wavelength_m: float

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int) -> "CubeGrid":
        """The grid of a radar's own FFTs for `num_frames` frames."""
        return cls(
            frame_time_s=np.arange(num_frames) * config.frame_period_s,
            range_m=config.range_m,
            radial_velocity_mps=config.radial_velocity_mps,
            antenna_position_m=config.antenna_position_m,
            wavelength_m=config.wavelength_m,
        )

    @property
    def shape(self) -> tuple[int, int, int, int]:
        return (
            len(self.frame_time_s), len(self.range_m), len(self.radial_velocity_mps), len(self.antenna_position_m)
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True, repr=False)
class AdcCube(ShownByFacts):
    """Raw ADC samples: complex64 (frame, loop, tx, rx, sample).

    `tx` is the physical transmitter, not its position in the firing order. `scale` is the amplitude at the receiver's
    port, in sqrt(mW), that the value 1.0 stands for; nan where it is unknown (a recording). The samples of a radar with
    a real-valued converter have zero imaginary parts.
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

    The TDM-MIMO phase is compensated, so antennas of one cell differ only by their positions. `scale` as in AdcCube.
    """

    values: CubeValues
    grid: CubeGrid
    config: RadarConfig
    scale: float

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
    """Detections of all frames, one row per point."""

    frame: np.ndarray  # (point,) int, index of the frame
    x_m: PerPoint
    y_m: PerPoint
    z_m: PerPoint
    radial_velocity_mps: PerPoint
    snr_db: PerPoint

    def facts(self) -> dict[str, str]:
        """How many points, and where."""
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

    Motion planning samples it densely (100 Hz and more), so that it can be interpolated in slow time; poses at the
    radar's frames are resampled from that.
    """

    time_s: PerFrame
    joints_m: Joints
    height_m: float
    subject: int = 0  # number of the body: its surface points and random phases

    def facts(self) -> dict[str, str]:
        """Times, joints and the body."""
        return {
            "frames": span(self.time_s, "s"),
            "joints": str(self.joints_m.shape[1]),
            "height": f"{self.height_m:.2f} m",
            "subject": str(self.subject),
        }


# Scene --------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class CameraIntrinsics:
    """Pinhole camera, in pixels of its picture; pixel centres at integer coordinates."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int


@dataclass(frozen=True, kw_only=True)
class ClassMask:
    """Class of each pixel: an index into `names`, COCO-Stuff names ("couch", "wall-concrete"); 0 = unknown."""

    index: ClassPixels
    names: tuple[str, ...]  # names[0] is "unlabeled"


@dataclass(frozen=True, kw_only=True, repr=False)
class RgbdPhoto(ShownByFacts):
    """A colour picture and its depth along the optical axis in metres; nan = no measurement."""

    rgb: RgbPixels
    depth_m: DepthPixels
    intrinsics: CameraIntrinsics
    classes: ClassMask | None = None  # where a segmentation is given

    def facts(self) -> dict[str, str]:
        """Size, and how much of it has a depth."""
        height, width = self.depth_m.shape
        return {
            "size": f"{width} x {height} pixels",
            "with depth": f"{100 * np.isfinite(self.depth_m).mean():.0f} %",
            "classes": "none" if self.classes is None else str(len(self.classes.names)),
        }


@dataclass(frozen=True, kw_only=True)
class Plane:
    """A flat rectangle of the room. axis_u, axis_v and normal are a right-handed orthonormal triple."""

    kind: str  # floor | ceiling | wall | top | panel
    centre_m: Vec3
    normal: Vec3  # towards the free side
    axis_u: Vec3
    axis_v: Vec3
    half_size_m: tuple[float, float]  # along axis_u, axis_v
    material: str


@dataclass(frozen=True, kw_only=True)
class FreeSpace:
    """Where on the floor a body can stand, on a square grid of cells."""

    x_m: np.ndarray  # (x,) centres of the columns
    y_m: np.ndarray  # (y,) centres of the rows
    is_free: GridMask  # nothing stands there between floor and head height
    is_seen: GridMask  # known from depth; a free cell that is not seen is assumed free


@dataclass(frozen=True, kw_only=True)
class Seat:
    """A flat surface at sitting height."""

    position_m: Vec3  # middle of where a person sits, on the surface
    facing_rad: float  # direction the sitter looks, from +x (right) towards +y (away from the radar)
    size_m: tuple[float, float]  # width across, depth along the facing


@dataclass(frozen=True, kw_only=True)
class Landmark:
    """Something that a sentence can name as a destination: a door, a table, a window, a bed."""

    kind: str  # the word for it: door | table | window | ...
    position_m: Vec3  # its middle
    approach_m: tuple[float, float]  # (x, y) of the floor where one stands to use it
    facing_rad: float  # direction one looks there, from +x (right) towards +y (away from the radar)


@dataclass(frozen=True, kw_only=True, repr=False)
class Scene(ShownByFacts):
    """The room of one photo, as ray caster and motion planner need it."""

    photo: RgbdPhoto
    radar_from_camera: Rotation  # camera x right, y down, z forward -> radar frame (same origin)
    vertices_m: Vertices
    faces: Faces
    face_material: PerFace  # index into material_names
    material_names: tuple[str, ...]
    planes: tuple[Plane, ...]  # the floor is always among them
    floor_z_m: float  # below the radar, so negative
    free_space: FreeSpace
    seats: tuple[Seat, ...]
    assumptions: tuple[str, ...]  # sentences for meta.json
    landmarks: tuple[Landmark, ...] = ()
    empty_recording: RadarCube | None = None  # the same radar in the same place, with nobody there

    def facts(self) -> dict[str, str]:
        """Sizes, and what a sentence can refer to."""
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
    """'floor, 3 wall' of ["wall", "floor", "wall", "wall"]."""
    counts = {kind: kinds.count(kind) for kind in sorted(set(kinds))}
    return ", ".join(kind if count == 1 else f"{count} {kind}" for kind, count in counts.items()) or "none"


def _bounds(values: np.ndarray, unit: str) -> str:
    return f"{values.min():.2f} to {values.max():.2f} {unit}" if len(values) else "none"
