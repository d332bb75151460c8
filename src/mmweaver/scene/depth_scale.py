"""What the counts of a depth picture mean: their unit, and whether they are depths or distances along the ray.

Few files state their unit. It follows from what rooms and cameras are like: a camera stands about 1.2 m above the
floor, what it shows reaches 1 to 3 m above the floor and some metres away; and from bit patterns (TUM's counts of
Kinects are multiples of 5, SUN RGB-D's are rotated by three bits). Planes tell depth from distance: the inverse depth
of a plane is linear in the picture, its inverse distance is not. Formats: table in docs/photos.md.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import normalized_coordinates
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.shapes import DepthPixels
from mmweaver.scene.layout.gravity import find_gravity
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.photo.picture_files import depth_in_metres

# name: metres per count, data sets and cameras that use it, and how common it is
UNITS: dict[str, tuple[float, str, float]] = {
    "mm": (1e-3, "millimetres", 0.7),
    "tum": (1 / 5000, "5000 counts a metre: TUM RGB-D, ICL-NUIM", 0.05),
    "replica": (1 / 6553.5, "6553.5 counts a metre: Replica of NICE-SLAM", 0.05),
    "kitti": (1 / 256, "256 counts a metre: KITTI, VOID", 0.05),
    "4000": (1 / 4000, "4000 counts a metre", 0.05),
    "10000": (1e-4, "0.1 mm", 0.05),
    "cm": (1e-2, "centimetres", 0.05),
}
KINDS, ROTATED = ("z", "ray", "disparity"), "sunrgbd"
NORMAL_M = 2.5  # median depth at which the room is looked at before its unit is known
# natural logarithm of a length in metres: median of rooms, spread
CAMERA_HEIGHT, SHOWN_HEIGHT, FAR = (np.log(1.2), 0.45), (np.log(2.1), 0.35), (np.log(3.8), 0.45)
CLEAR = 4.0  # ratio of the likelihoods of the two best readings; below, the user has to choose
MIN_VALUES, OF_FIVE = 64, 1e3  # different counts, all multiples of 5: a Kinect's millimetres times 5
POSSIBLE = 2e-3  # likelihood of the best reading relative to a typical room's; below, none fits
KINECT_BASE_MM, KINECT_INFINITY = 351.3e3, 1092.5  # depth = base / (infinity - disparity); NYU Depth V2's toolbox
MAX_DISPARITY = 2047
SMOOTHER = 1.5  # ratio of the steps between neighbours as stored and with bytes swapped; below 0.3 for depth
WINDOW, MIN_MEASURED, FLAT = 20, 0.8, 0.01  # cells of a window, share of them measured, relative error of a flat one
RAY_BEND, MIN_WINDOWS = 0.5, 10  # on real and rendered rooms depths give -0.2 to 0, distances 0.9 to 1.3


@dataclass(frozen=True, kw_only=True)
class DepthScale:
    """Metres per count, and the sentence that reports how it was found."""

    unit_m: float
    note: str


@dataclass(frozen=True, kw_only=True)
class DepthReading:
    """How a depth picture is read; None estimates it.

    Attributes:
        unit: Name in UNITS, "sunrgbd", or metres per count.
        kind: One of KINDS.
        stated_unit_m: Metres per count that a camera file states.
    """

    unit: str | None = None
    kind: str | None = None
    stated_unit_m: float | None = None

    def depth(self, path: Path, raw: np.ndarray, camera: CameraIntrinsics) -> tuple[DepthPixels, list[str]]:
        """Depth in metres, (height, width), with sentences on what was estimated.

        Args:
            path: The file, for messages.
            raw: Counts or floats as stored, (height, width).
            camera: The camera, in pixels of `raw`.

        Raises:
            InputError: If the values cannot be depth, or their unit stays open.
        """
        if self.kind is not None and self.kind not in KINDS:
            raise InputError(f"unknown kind of depth {self.kind!r}; known: {', '.join(KINDS)}")
        if self.kind == "disparity":
            return depth_in_metres(path, depth_of_disparity(raw), 1.0), []
        counts, unit_m, notes = self._unit(path, raw, camera)
        depth_m = depth_in_metres(path, counts, unit_m)
        is_open = self.kind is None and self.stated_unit_m is None
        if self.kind == "ray" or (is_open and is_ray_distance(depth_m, camera)):
            depth_m = depth_along_axis(depth_m, camera)
            if self.kind is None:
                notes.append(
                    f"The values of {path.name} were taken as distances along the ray, since only then surfaces are"
                    " flat (--depth-kind ray)."
                )
        return depth_m, notes

    def _unit(
        self, path: Path, raw: np.ndarray, camera: CameraIntrinsics
    ) -> tuple[np.ndarray, float | None, list[str]]:
        """Counts, metres per count (None: floats in metres), and sentences."""
        if raw.dtype.kind not in "ui":
            return raw, None, []
        refuse_swapped_bytes(raw, path.name)
        is_sun = self.unit is None and self.stated_unit_m is None and is_rotated(raw)
        if self.unit == ROTATED or is_sun:
            note = f"The bits of {path.name} were rotated back by three, as SUN RGB-D stores millimetres"
            return rotated_by_three(raw), UNITS["mm"][0], [f"{note} (--depth-unit {ROTATED})."] if is_sun else []
        if self.unit is not None:
            return raw, unit_of_name(self.unit), []
        if self.stated_unit_m is not None:
            return raw, self.stated_unit_m, []
        found = estimate_unit(raw, camera, path.name)
        return raw, found.unit_m, [found.note]


def unit_of_name(given: str) -> float:
    """Metres per count of a name in UNITS, or of a number of metres.

    Args:
        given: Name, or number.

    Raises:
        InputError: If it is neither.

    >>> unit_of_name("tum"), unit_of_name("0.001")
    (0.0002, 0.001)
    """
    if given in UNITS:
        return UNITS[given][0]
    try:
        unit_m = float(given)
    except ValueError:
        unit_m = float("nan")
    if not 1e-6 <= unit_m <= 1:
        raise InputError(f"{given!r} is no unit of depth; give {', '.join(UNITS)}, or the metres in one count")
    return unit_m


def estimate_unit(counts: np.ndarray, intrinsics: CameraIntrinsics, name: str) -> DepthScale:
    """Estimates the unit of a depth picture from the room that it shows.

    Args:
        counts: Integers, (height, width); 0 is a hole.
        intrinsics: The camera, in pixels of `counts`.
        name: The file, for messages.

    Returns:
        The unit, with a sentence that reports it.

    Raises:
        InputError: If two readings are about as likely, or none is.
    """
    measured = counts[(counts > 0) & (counts < np.iinfo(np.uint16).max)]
    if not len(measured):
        return DepthScale(unit_m=UNITS["mm"][0], note="")
    median = float(np.median(measured))
    lengths = _lengths(counts, intrinsics, median)
    likelihood = {one: _likelihood(one, lengths, median) for one in UNITS}
    if len(np.unique(measured)) > MIN_VALUES and not (measured % 5).any():
        likelihood["tum"] *= OF_FIVE
    first, second, third = sorted(UNITS, key=lambda one: -likelihood[one])[:3]
    is_clear = likelihood[first] > max(CLEAR * likelihood[second], POSSIBLE * UNITS[first][2])
    if is_clear and (first == "mm" or "camera" in lengths):  # without a floor only the usual unit is believed
        seen = _seen(lengths, UNITS[first][0] * median / NORMAL_M)
        return DepthScale(unit_m=UNITS[first][0], note=_sentence(name, first, seen))
    readings = [
        f"--depth-unit {one} ({_seen(lengths, UNITS[one][0] * median / NORMAL_M)})" for one in (first, second, third)
    ]
    raise InputError(
        f"{name}: the unit of the depth is not clear from the room that it shows; give {', '.join(readings[:2])} or"
        f" {readings[2]}"
    )


def _lengths(counts: np.ndarray, intrinsics: CameraIntrinsics, median: float) -> dict[str, float]:
    """Camera height, height shown above the floor and far depth, if the median depth were NORMAL_M."""
    depth_m = np.where(counts > 0, counts * (NORMAL_M / median), np.nan)
    lengths = {"far": float(np.nanpercentile(depth_m, 95))}
    try:
        grid = make_grid(RgbdPhoto(rgb=np.zeros((*counts.shape, 3), np.uint8), depth_m=depth_m, intrinsics=intrinsics))
        gravity = find_gravity(grid)
    except InputError:
        return lengths
    if gravity.has_floor:
        height = (grid.points_m[np.isfinite(grid.depth_m)] @ gravity.up_camera) - gravity.floor_z_m
        lengths |= {"camera": -gravity.floor_z_m, "shown": float(np.percentile(height, 98))}
    return lengths


def _likelihood(name: str, lengths: dict[str, float], median: float) -> float:
    unit_m, _, prior = UNITS[name]
    total = 0.0
    for one, (typical, spread) in (("camera", CAMERA_HEIGHT), ("shown", SHOWN_HEIGHT), ("far", FAR)):
        if one in lengths:
            total -= 0.5 * ((np.log(lengths[one] * unit_m * median / NORMAL_M) - typical) / spread) ** 2
    return prior * float(np.exp(total))


def _seen(lengths: dict[str, float], scale: float) -> str:
    far = f"it reaches {lengths['far'] * scale:.1f} m away"
    return f"camera {lengths['camera'] * scale:.2f} m above the floor, {far}" if "camera" in lengths else far


def _sentence(name: str, unit: str, why: str) -> str:
    return f"The depth of {name} was taken as {UNITS[unit][1]}: {why} (--depth-unit {unit})."


def refuse_swapped_bytes(counts: np.ndarray, name: str) -> None:
    """Rejects 16-bit counts whose bytes are swapped, as in NYU's raw Kinect frames.

    Args:
        counts: Integers, (height, width).
        name: The file, for messages.

    Raises:
        InputError: If neighbours are alike only with the bytes swapped.
    """
    if counts.dtype != np.uint16 or len(np.unique(counts)) <= MIN_VALUES:
        return
    if _step(counts) > SMOOTHER * _step(counts.byteswap()):
        held = counts.byteswap()
        advice = "give --depth-kind disparity" if held.max() <= MAX_DISPARITY else "swap them and save it again"
        raise InputError(
            f"{name} is no depth as it is: neighbouring values jump, with their bytes swapped not; {advice}"
        )


def _step(counts: np.ndarray) -> float:
    """Mean step between neighbours relative to the mean value."""
    values = counts.astype(np.int64)
    return float(np.abs(np.diff(values, axis=1)).mean() / max(float(values.mean()), 1e-9))


def depth_of_disparity(counts: np.ndarray) -> DepthPixels:
    """Depth of a Kinect's raw disparities, in either byte order.

    Args:
        counts: 11-bit disparities, (height, width); 2047 is a hole.

    Returns:
        Depth in metres, nan without a measurement.

    Raises:
        InputError: If the values have more than 11 bits in both byte orders.
    """
    held = next((one for one in (counts, counts.byteswap()) if one.max() <= MAX_DISPARITY), None)
    if held is None:
        raise InputError(f"the disparities of a Kinect are at most {MAX_DISPARITY}, not {counts.max()}")
    distance = np.where(held < KINECT_INFINITY - 10, KINECT_INFINITY - held, np.nan)
    return np.where(held > 0, KINECT_BASE_MM / 1e3 / distance, np.nan)


def depth_along_axis(distance_m: DepthPixels, intrinsics: CameraIntrinsics) -> DepthPixels:
    """Depth along the optical axis from distance along each pixel's ray, both in metres."""
    x, y = normalized_coordinates(intrinsics)
    return distance_m / np.sqrt(1 + x**2 + y**2)


def is_ray_distance(depth_m: DepthPixels, intrinsics: CameraIntrinsics) -> bool:
    """Whether surfaces are flat only if the values are taken as distances along the ray.

    Args:
        depth_m: Values in any unit, (height, width), nan without a measurement.
        intrinsics: The camera.
    """
    depth_m = depth_m * (NORMAL_M / np.nanmedian(depth_m))
    grid = make_grid(RgbdPhoto(rgb=np.zeros((*depth_m.shape, 3), np.uint8), depth_m=depth_m, intrinsics=intrinsics))
    x, y = np.broadcast_arrays(*normalized_coordinates(grid.intrinsics))
    bends = []
    for row in range(0, grid.depth_m.shape[0] - WINDOW + 1, WINDOW // 2):
        for column in range(0, grid.depth_m.shape[1] - WINDOW + 1, WINDOW // 2):
            window = np.s_[row : row + WINDOW, column : column + WINDOW]
            measured = np.isfinite(grid.depth_m[window])
            if measured.sum() >= MIN_MEASURED * WINDOW**2:
                bends += _bend(x[window][measured], y[window][measured], grid.depth_m[window][measured])
    if len(bends) < MIN_WINDOWS:
        return False
    bend, weight = np.array(bends).T
    return min(float(np.median(bend)), float(np.average(bend, weights=weight))) > RAY_BEND


def _bend(x: np.ndarray, y: np.ndarray, values: np.ndarray) -> list[tuple[float, float]]:
    """How much a window is bent like the distances of a plane (1; its depths: 0), and the weight; none if not flat."""
    inverse = values.mean() / values
    plane = np.stack([x, y, np.ones_like(x)], axis=1)

    def fitted(values: np.ndarray) -> np.ndarray:
        return plane @ np.linalg.lstsq(plane, values, rcond=None)[0]

    level = fitted(inverse)
    shape = level * (1 / np.sqrt(1 + x**2 + y**2) - 1)
    shape, rest = shape - fitted(shape), inverse - level
    energy = max(float(shape @ shape), 1e-12)
    bend = float(shape @ rest) / energy
    error = float(np.sqrt(np.mean((rest - bend * shape) ** 2)))
    return [(bend, energy / max(error, 1e-3) ** 2)] if error < FLAT else []


def rotated_by_three(counts: np.ndarray) -> np.ndarray:
    """Counts of SUN RGB-D: 16 bits rotated by three to the left; millimetres once rotated back.

    Args:
        counts: uint16, (height, width).

    Returns:
        Millimetres, uint16.
    """
    return (counts >> np.uint16(3)) | (counts << np.uint16(13))


def is_rotated(counts: np.ndarray) -> bool:
    """Whether 16-bit counts have only zeros in their lowest three bits, as SUN RGB-D's below 8.192 m."""
    return counts.dtype == np.uint16 and not (counts & np.uint16(7)).any() and len(np.unique(counts)) > 32
