"""The task of a recogniser, as a page of TOML describes it: radar, activities in sentences, mount, recordings.

radar = "profile.cfg"
window_s = 2.0
clouds = "recorded"                # optional: "varied" has wide ranges of levels and open rooms
background = "empty_place.dat"     # optional: a recording of the empty place
unlabelled = "some_recordings/"    # optional: recordings without labels

[activities]
walking = ["a person walks", "a person walks slowly"]
empty = "nobody"

[mount]                            # what is known of where the radar stands
height_m = 1.2
tilt_deg = 0.0
distance_m = [1.0, 3.0]

[recordings]
columns = ["x_right", "y_ahead", "z_up", "velocity", "snr"]
frame_rate_hz = 10.0
gap_frames = 5
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.io.radar_file import load_firmware, load_radar
from mmweaver.io.radar_options import split_radar
from mmweaver.motion.register_activity import NOBODY, activities_of

# Known names of each table, with the limits of those that are numbers.
TABLES: dict[str, dict[str, tuple[float, float] | None]] = {
    "": dict.fromkeys(("radar", "clouds", "background", "unlabelled", "activities", "mount", "recordings"))
    | {
        "window_s": (0.2, 60.0),
    },
    "mount": {"height_m": (0.0, 5.0), "tilt_deg": (-90.0, 90.0), "distance_m": (0.2, 20.0)},
    "recordings": {"columns": None, "frame_rate_hz": (0.5, 200.0), "gap_frames": (0.0, 1e6)},
}
# Words in names of columns: axis (right, ahead, up) and sign.
DIRECTIONS = {"right": (0, 1), "left": (0, -1), "ahead": (1, 1), "up": (2, 1), "down": (2, -1)}
VELOCITIES = {"velocity": 1, "velocity_away": 1, "velocity_towards": -1}
STRENGTHS = ("snr", "snr_db")
VARIED, RECORDED = CLOUDS = ("varied", "recorded")
AXES = ("right or left", "ahead", "up or down")


@dataclass(frozen=True, kw_only=True)
class RecordedColumns:
    """Meaning of the columns of a stored point cloud.

    "x_right", "x_ahead", "y_left", "z_up" are directions; "velocity" (away +) or "velocity_towards"; "snr". Columns of
    other names are ignored.
    """

    names: tuple[str, ...]

    @staticmethod
    def of(names: object, place: str) -> "RecordedColumns":
        """Checks names of columns.

        Args:
            names: Value of the task file.
            place: Where it comes from, for the error.

        Raises:
            InputError: If a direction or the velocity is missing or occurs twice.
        """
        if not isinstance(names, Sequence) or isinstance(names, str) or not all(isinstance(one, str) for one in names):
            raise InputError(f'{place}: columns must be a list such as ["x_right", "y_ahead", "z_up", "velocity"]')
        found = RecordedColumns(names=tuple(map(str, names)))
        axes = [axis for _, axis, _ in found._directions()]
        for axis, words in enumerate(AXES):
            if axes.count(axis) != 1:
                raise InputError(f'{place}: one column must point {words}; name it so, for example "x_right"')
        if sum(name in VELOCITIES for name in found.names) != 1:
            raise InputError(f'{place}: one column must be "velocity" (away +) or "velocity_towards"')
        return found

    def _directions(self) -> list[tuple[int, int, int]]:
        """Column, axis and sign of each direction."""
        words = [name.rpartition("_")[2] for name in self.names]
        return [(column, *DIRECTIONS[word]) for column, word in enumerate(words) if word in DIRECTIONS]

    def cloud(self, frame: np.ndarray, pts: np.ndarray, place: str) -> PointCloud:
        """The points of a stored cloud.

        Args:
            frame: Frame numbers (point,).
            pts: Values (point, column).
            place: Where they come from, for the error.

        Raises:
            InputError: If the number of columns differs.
        """
        if pts.ndim != 2 or pts.shape[1] != len(self.names):
            raise InputError(f"{place}: pts is {pts.shape}, but {len(self.names)} columns are named")
        xyz = np.zeros((3, len(pts)))
        for column, axis, sign in self._directions():
            xyz[axis] = sign * pts[:, column]
        snr_db, velocity = np.full(len(pts), np.nan), np.zeros(len(pts))
        for name, values in zip(self.names, pts.T, strict=True):
            if name in STRENGTHS:
                snr_db = values.astype(float)
            elif name in VELOCITIES:
                velocity = VELOCITIES[name] * values.astype(float)
        return PointCloud(frame=frame, x_m=xyz[0], y_m=xyz[1], z_m=xyz[2], radial_velocity_mps=velocity, snr_db=snr_db)


@dataclass(frozen=True, kw_only=True)
class Mount:
    """Position of the radar; None where unknown."""

    height_m: float | None = None  # above the floor
    tilt_deg: float | None = None  # downwards
    distance_m: tuple[float, float] | None = None  # of people, nearest and farthest


@dataclass(frozen=True, kw_only=True)
class RecordingSettings:
    """How recordings are read and cut into windows, generated and real ones alike."""

    labels: tuple[str, ...]  # in alphabetical order
    window_s: float
    frame_rate_hz: float
    gap_frames: int | None = None  # more frames without points end a sample; None never splits recordings
    columns: RecordedColumns | None = None  # of pts in .npz recordings; None lets `read_points` decide
    empty_label: str | None = None  # label of the empty room (the sentence `nobody`), if there is one

    @property
    def window_frames(self) -> int:
        """Frames per window."""
        return max(round(self.window_s * self.frame_rate_hz), 1)

    @property
    def has_single_performances(self) -> bool:
        """Whether a sample is a single performance: then even a pause shorter than a window ends it."""
        return self.gap_frames is not None and self.gap_frames <= self.window_frames


@dataclass(frozen=True, kw_only=True)
class RecognitionTask:
    """Activities to be recognised, and the radar; everything else has defaults."""

    radar: RadarConfig  # at the frame rate of the recordings
    firmware: FirmwareSettings
    activities: dict[str, tuple[str, ...]]
    recordings: RecordingSettings
    mount: Mount = Mount()
    background: Path | None = None
    unlabelled: Path | None = None
    clouds: str = VARIED  # RECORDED: with the levels, rooms and skin of recorded clouds


def read_task(file: Path | str) -> RecognitionTask:
    """Reads a task file; paths in it are relative to its folder.

    Args:
        file: The task as TOML.

    Raises:
        InputError: For missing, unknown or impossible entries.
    """
    file = Path(file)
    content = _checked(read_toml(file), "", file)
    mount, recordings = (_checked(content.get(name, {}), name, file) for name in ("mount", "recordings"))
    source = content.get("radar")
    if not isinstance(source, str):
        raise InputError(f'{file} names no radar; write radar = "profile.cfg", or a preset such as "awr1843"')
    if (file.parent / split_radar(source)[0]).is_file():  # else a preset, or a path from the working folder
        source = str(file.parent / source)
    radar = load_radar(source)
    rate_hz = recordings.get("frame_rate_hz") or 1 / radar.frame_period_s
    gap, columns = recordings.get("gap_frames"), recordings.get("columns")
    activities = activities_of(content, file, with_nobody=True)
    firmware = load_firmware(source)
    # levels and rooms were fitted to clouds of an IWR6843; tasks of the IWR1443 were developed with wide ranges
    clouds = content.get("clouds", RECORDED if firmware.device == "xwr16xx" else VARIED)
    if clouds not in CLOUDS:
        raise InputError(f"{file}: clouds must be {' or '.join(CLOUDS)}, not {clouds!r}")
    return RecognitionTask(
        radar=replace(radar, frame_period_s=1 / rate_hz),
        firmware=firmware,
        activities=activities,
        recordings=RecordingSettings(
            labels=tuple(sorted(activities)),
            window_s=content.get("window_s", 2.0),
            frame_rate_hz=rate_hz,
            gap_frames=None if gap is None else int(gap),
            columns=None if columns is None else RecordedColumns.of(columns, str(file)),
            empty_label=next((label for label, sentences in activities.items() if sentences == (NOBODY,)), None),
        ),
        mount=Mount(**mount),
        background=_place(content, "background", file),
        unlabelled=_place(content, "unlabelled", file),
        clouds=clouds,
    )


def _checked(table: object, name: str, file: Path) -> dict[str, Any]:
    """A table with known names alone, numbers as floats. Raises InputError."""
    if not isinstance(table, dict):
        raise InputError(f"{file}: {name} must be a table, [{name}]")
    checked: dict[str, Any] = {}
    for key, value in table.items():
        if key not in TABLES[name]:
            where = f" in [{name}]" if name else ""
            raise InputError(f"{file}: {key!r}{where} is unknown; known are {', '.join(TABLES[name])}")
        limits = TABLES[name][key]
        if key == "distance_m":
            if not isinstance(value, list) or len(value) != 2:
                raise InputError(f"{file}: {key} must be two numbers, [near, far]")
            checked[key] = tuple(_number(one, key, limits or (0, 0), file) for one in value)
            if value[0] > value[1]:
                raise InputError(f"{file}: {key} = [{value[0]:g}, {value[1]:g}] must rise")
        else:
            checked[key] = value if limits is None else _number(value, key, limits, file)
    return checked


def _number(value: object, name: str, limits: tuple[float, float], file: Path) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not limits[0] <= value <= limits[1]:
        raise InputError(f"{file}: {name} must be a number from {limits[0]:g} to {limits[1]:g}, not {value!r}")
    return float(value)


def _place(content: dict[str, Any], name: str, file: Path) -> Path | None:
    place = content.get(name)
    if place is None:
        return None
    if not isinstance(place, str) or not (file.parent / place).exists():
        raise InputError(f"{file}: {name} must name a recording or a folder of them; {place!r} is not there")
    return file.parent / place
