"""Records that packages exchange.

All positions are in the radar's frame: x right, y away from the radar, z up (against gravity), in metres, origin at the
radar. Radial velocity is positive for receding targets.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import AT_CAMERA, RadarPose
from mmweaver.core.record_values import ShownByFacts, span
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
from mmweaver.core.targets import Interferer, Reflector, Thing


# Radar --------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class CubeGrid:
    """Axes of a RadarCube, one per dimension, in the order of its dimensions."""

    frame_time_s: PerFrame  # start of each frame
    range_m: PerRange
    radial_velocity_mps: PerDoppler
    antenna_position_m: AntennaPositions  # virtual antennas, tx + rx
    wavelength_m: float

    @classmethod
    def of(cls, config: RadarConfig, num_frames: int, first_frame: int = 0) -> "CubeGrid":
        """Axes of the range-Doppler cube of a radar.

        Args:
            config: The radar.
            num_frames: Number of frames.
            first_frame: Index of the first frame. Default: 0.

        Returns:
            The grid.
        """
        return cls(
            frame_time_s=np.arange(first_frame, first_frame + num_frames) * config.frame_period_s,
            range_m=config.range_m,
            radial_velocity_mps=config.radial_velocity_mps,
            antenna_position_m=config.antenna_position_m,
            wavelength_m=config.wavelength_m,
        )

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Shape of the cube, (frame, range, doppler, antenna)."""
        return (len(self.frame_time_s), len(self.range_m), len(self.radial_velocity_mps), len(self.antenna_position_m))


@dataclass(frozen=True, kw_only=True, repr=False)
class AdcCube(ShownByFacts):
    """ADC samples: complex64 (frame, loop, tx, rx, sample).

    Attributes:
        samples: The samples; real-valued ones have zero imaginary part. `tx` is the physical transmitter, not its
            position in the firing order.
        config: The radar.
        scale: Amplitude of the value 1.0 in sqrt(mW) at the receiver input; nan if unknown (recordings).
    """

    samples: AdcValues
    config: RadarConfig
    scale: float

    def facts(self) -> dict[str, str]:
        """Sizes, dtype and radar."""
        names = ("frames", "loops", "transmitters", "receivers", "samples")
        sizes = {name: str(size) for name, size in zip(names, self.samples.shape, strict=True)}
        return {**sizes, "type": str(self.samples.dtype), "radar": self.config.name}


@dataclass(frozen=True, kw_only=True, repr=False)
class RadarCube(ShownByFacts):
    """Range-Doppler spectrum per virtual antenna: complex64 (frame, range, doppler, antenna).

    The TDM phase is compensated, so the antennas of a cell differ only by their positions. `scale` as in AdcCube.
    """

    values: CubeValues
    grid: CubeGrid
    config: RadarConfig
    scale: float

    def select(self, frames: slice | np.ndarray) -> "RadarCube":
        """Selects frames.

        Args:
            frames: Slice, mask or indices along the frame axis.

        Returns:
            Cube of these frames.
        """
        grid = CubeGrid(
            frame_time_s=self.grid.frame_time_s[frames],
            range_m=self.grid.range_m,
            radial_velocity_mps=self.grid.radial_velocity_mps,
            antenna_position_m=self.grid.antenna_position_m,
            wavelength_m=self.grid.wavelength_m,
        )
        return RadarCube(values=self.values[frames], grid=grid, config=self.config, scale=self.scale)

    def facts(self) -> dict[str, str]:
        """Axes, dtype and radar."""
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

    frame: np.ndarray  # (point,) int, frame index
    x_m: PerPoint
    y_m: PerPoint
    z_m: PerPoint
    radial_velocity_mps: PerPoint
    snr_db: PerPoint

    @property
    def xyz_m(self) -> np.ndarray:
        """Positions in metres, (point, 3)."""
        return np.stack([self.x_m, self.y_m, self.z_m], axis=1)

    @property
    def range_m(self) -> np.ndarray:
        """Range of each point in metres, (point,)."""
        return np.sqrt(self.x_m**2 + self.y_m**2 + self.z_m**2)

    def select(self, which: np.ndarray) -> "PointCloud":
        """Selects points.

        Args:
            which: Mask or indices, (point,).

        Returns:
            The selected points.
        """
        return PointCloud(**{field.name: getattr(self, field.name)[which] for field in fields(PointCloud)})

    def facts(self) -> dict[str, str]:
        """Number of points and their bounds."""
        bounds = {"x": (self.x_m, "m"), "y": (self.y_m, "m"), "z": (self.z_m, "m")}
        bounds |= {"velocity": (self.radial_velocity_mps, "m/s"), "SNR": (self.snr_db, "dB")}
        return {
            "points": str(len(self.frame)),
            "frames": str(len(np.unique(self.frame))),
            **{name: _bounds(values, unit) for name, (values, unit) in bounds.items()},
        }


# Motion -------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class Breathing:
    """What a sentence asks of a person's breathing; the rest is sampled (`motion.physiology`)."""

    per_minute: float | None = None
    held_s: tuple[tuple[float, float], ...] = ()  # intervals in which the breath is held


@dataclass(frozen=True, kw_only=True)
class VitalTruth:
    """Ground truth of one person's vital signs over the frames of a signal.

    Attributes:
        breathing_hz: Mean rate outside held breaths; nan if the breath is held throughout.
        heart_hz: Mean heart rate.
        chest_m: Outward displacement of the chest's front (frame,) in metres, breathing and heartbeat.
        belly_m: Outward displacement of the belly (frame,) in metres.
        beat_s: Times of the heartbeats within the signal, (beat,).
        held_s: Intervals in which the breath is held, (hold, 2).
    """

    breathing_hz: float
    heart_hz: float
    chest_m: np.ndarray
    belly_m: np.ndarray
    beat_s: np.ndarray
    held_s: np.ndarray


@dataclass(frozen=True, kw_only=True, repr=False)
class PoseSequence(ShownByFacts):
    """Joints of one person over time in the radar's frame, in SMPL order (`core.skeleton`).

    Motions are sampled densely (100 Hz or more) so that slow time can be interpolated; results contain a sequence
    resampled at the radar's frames.
    """

    time_s: PerFrame
    joints_m: Joints
    height_m: float
    subject: int = 0  # identifies the body: surface points and speckle
    girth: float = 1.0  # thickness of trunk and limbs relative to the average body of this height
    breathing: Breathing = Breathing()
    cover_db: float = 0.0  # two-way loss of a sheet or blanket over the whole body
    vitals: VitalTruth | None = None  # of a result, whose joints include sway and tremor

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
    """Pinhole camera in pixels of its picture; pixel centres are at integers."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int


@dataclass(frozen=True, kw_only=True)
class ClassMask:
    """Semantic class of each pixel, with names of COCO-Stuff ("couch", "wall-concrete")."""

    index: ClassPixels  # into `names`; 0 = unknown
    names: tuple[str, ...]  # names[0] is "unlabeled"


@dataclass(frozen=True, kw_only=True, repr=False)
class RgbdPhoto(ShownByFacts):
    """Colour picture with depth along the optical axis in metres; nan = no measurement."""

    rgb: RgbPixels
    depth_m: DepthPixels
    intrinsics: CameraIntrinsics
    classes: ClassMask | None = None  # given by the user or by a segmenter

    def facts(self) -> dict[str, str]:
        """Size, share of pixels with depth, number of classes."""
        height, width = self.depth_m.shape
        return {
            "size": f"{width} x {height} pixels",
            "with depth": f"{100 * np.isfinite(self.depth_m).mean():.0f} %",
            "classes": "none" if self.classes is None else str(len(self.classes.names)),
        }


@dataclass(frozen=True, kw_only=True)
class Plane:
    """A planar rectangle of the room; axis_u, axis_v and normal form a right-handed orthonormal basis."""

    kind: str  # floor | ceiling | wall | top | panel
    centre_m: Vec3
    normal: Vec3  # towards the free side
    axis_u: Vec3
    axis_v: Vec3
    half_size_m: tuple[float, float]  # along axis_u, axis_v
    material: str

    @property
    def area_m2(self) -> float:
        """Area in square metres."""
        return 4 * self.half_size_m[0] * self.half_size_m[1]

    @property
    def corners_m(self) -> np.ndarray:
        """Corners in metres, (4, 3), counterclockwise seen from the free side."""
        u, v = self.half_size_m[0] * self.axis_u, self.half_size_m[1] * self.axis_v
        return np.stack([self.centre_m - u - v, self.centre_m + u - v, self.centre_m + u + v, self.centre_m - u + v])

    def spanned(self, low_m: np.ndarray | tuple[float, float], high_m: np.ndarray | tuple[float, float]) -> "Plane":
        """Rectangle in the same plane between two corners.

        Args:
            low_m: Lower corner along axis_u and axis_v relative to the centre, metres, (2,).
            high_m: Upper corner, in the same way.

        Returns:
            The rectangle.
        """
        (left, below), (right, above) = low_m, high_m
        centre_m = self.centre_m + (left + right) / 2 * self.axis_u + (below + above) / 2 * self.axis_v
        return replace(self, centre_m=centre_m, half_size_m=(float(right - left) / 2, float(above - below) / 2))

    def moved(self, points: Callable[[Vec3], Vec3], directions: Callable[[Vec3], Vec3]) -> "Plane":
        """Transforms the rectangle to another frame.

        Args:
            points: Maps a point (3,) in metres.
            directions: Maps a direction (3,), without translation.

        Returns:
            The rectangle in the other frame.
        """
        return replace(
            self,
            centre_m=points(self.centre_m),
            normal=directions(self.normal),
            axis_u=directions(self.axis_u),
            axis_v=directions(self.axis_v),
        )


@dataclass(frozen=True, kw_only=True)
class FreeSpace:
    """Floor positions where a body may stand, on a square grid."""

    x_m: np.ndarray  # (x,) centres of the columns
    y_m: np.ndarray  # (y,) centres of the rows
    is_free: GridMask  # free from the floor to head height
    is_seen: GridMask  # measured; unseen free cells are assumed to be free
    is_assumed: GridMask | None = None  # unseen but probably free; last resort of motion planning


@dataclass(frozen=True, kw_only=True)
class Seat:
    """A horizontal surface at seat height."""

    position_m: Vec3  # middle of the seat, on the surface
    facing_rad: float  # direction of the sitter, from +x (right) towards +y (away from the radar)
    size_m: tuple[float, float]  # across and along that direction


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
    "bin",
    "mirror",
    "whiteboard",
    "toilet",
    "bathtub",
    "printer",
    "microwave",
    "dishwasher",
    "radiator",
    "piano",
    "fireplace",
)


@dataclass(frozen=True, kw_only=True)
class Landmark:
    """An object that a sentence may name as a destination."""

    kind: str  # one of LANDMARK_KINDS; photos yield door | window | table | counter | bed
    position_m: Vec3  # centre
    approach_m: tuple[float, float]  # (x, y) of a person using it
    facing_rad: float  # direction of that person, from +x (right) towards +y (away from the radar)


@dataclass(frozen=True, kw_only=True, repr=False)
class Scene(ShownByFacts):
    """A room for ray casting and motion planning, reconstructed from a photo or procedural, in the radar's frame."""

    photo: RgbdPhoto
    radar_from_camera: Rotation  # camera x right, y down, z forward -> radar frame
    vertices_m: Vertices
    faces: Faces
    face_material: PerFace  # index into material_names
    material_names: tuple[str, ...]
    planes: tuple[Plane, ...]  # including the floor
    floor_z_m: float  # negative: below the radar
    free_space: FreeSpace
    seats: tuple[Seat, ...]
    assumptions: tuple[str, ...]  # sentences for meta.json
    landmarks: tuple[Landmark, ...] = ()
    radar_pose: RadarPose = AT_CAMERA  # pose of the radar that defines the frame; the photo is always the camera's
    reflectors: tuple[Reflector, ...] = ()  # in the camera's level frame, as things
    things: tuple[Thing, ...] = ()
    interferers: tuple[Interferer, ...] = ()

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
        """The floor plane."""
        return next(plane for plane in self.planes if plane.kind == "floor")


def _counted(kinds: list[str]) -> str:
    """Formats the counts of kinds: "floor, 3 wall" for ["wall", "floor", "wall", "wall"]."""
    counts = {kind: kinds.count(kind) for kind in sorted(set(kinds))}
    return ", ".join(kind if count == 1 else f"{count} {kind}" for kind, count in counts.items()) or "none"


def _bounds(values: np.ndarray, unit: str) -> str:
    return f"{values.min():.2f} to {values.max():.2f} {unit}" if len(values) else "none"
