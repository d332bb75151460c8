"""The task of a recogniser, as a page of TOML says it: radar, activities in sentences, mount, recordings.

radar = "profile.cfg"
window_s = 2.0
background = "empty_place.dat"     # optional: a recording of the place with nobody in it
unlabelled = "some_recordings/"    # optional: recordings whose activities nobody has written down

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

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.formats.radar_file import load_firmware, load_radar
from mmweaver.formats.radar_options import split_radar
from mmweaver.motion.worded_activities import NOBODY, activities_of
from mmweaver.recognition.recorded_columns import RecordedColumns

TABLES = {
    "": ("radar", "window_s", "background", "unlabelled", "activities", "mount", "recordings"),
    "mount": ("height_m", "tilt_deg", "distance_m"),
    "recordings": ("columns", "frame_rate_hz", "gap_frames"),
}
WINDOW_S, HEIGHT_M, TILT_DEG, DISTANCE_M, RATE_HZ = (0.2, 60.0), (0.0, 5.0), (-90.0, 90.0), (0.2, 20.0), (0.5, 200.0)
GAP_FRAMES = (0.0, 1e6)


@dataclass(frozen=True, kw_only=True)
class Mount:
    """Where the radar stands; None = unknown."""

    height_m: float | None = None  # above the floor
    tilt_deg: float | None = None  # downwards
    distance_m: tuple[float, float] | None = None  # of people, nearest and farthest


@dataclass(frozen=True, kw_only=True)
class RecordingSettings:
    """How recordings are read and cut into windows, generated ones as real ones."""

    labels: tuple[str, ...]  # in alphabetical order
    window_s: float
    frame_rate_hz: float
    gap_frames: int | None = None  # more frames without points end a sample; None: recordings are never cut
    columns: RecordedColumns | None = None  # of pts in .npz recordings; None: as `read_points` finds
    empty_label: str | None = None  # of an empty place, the sentence `nobody`; None: no label is

    @property
    def window_frames(self) -> int:
        """Frames in a window."""
        return max(round(self.window_s * self.frame_rate_hz), 1)

    @property
    def has_single_performances(self) -> bool:
        """Whether a sample is one performance: even a pause shorter than a window ends it."""
        return self.gap_frames is not None and self.gap_frames <= self.window_frames


@dataclass(frozen=True, kw_only=True)
class RecognitionTask:
    """What is to be recognised with which radar; everything else the project chooses."""

    radar: RadarConfig  # at the frame rate of the recordings
    firmware: FirmwareSettings
    activities: dict[str, tuple[str, ...]]
    recordings: RecordingSettings
    mount: Mount = Mount()
    background: Path | None = None
    unlabelled: Path | None = None


def read_task(file: Path | str) -> RecognitionTask:
    """Reads a task file; paths in it count from its folder.

    Raises InputError for what is missing, unknown or impossible.
    """
    file = Path(file)
    content = read_toml(file)
    mount, recordings = _table(content, "mount", file), _table(content, "recordings", file)
    _only_known(content, "", file)
    if not isinstance(content.get("radar"), str):
        raise InputError(f'{file} names no radar; write radar = "profile.cfg", or a preset such as "awr1843"')
    said = _radar_of(content["radar"], file.parent)
    radar = load_radar(said)
    rate_hz = _number(recordings, "frame_rate_hz", RATE_HZ, file) or 1 / radar.frame_period_s
    gap = _number(recordings, "gap_frames", GAP_FRAMES, file)
    columns = recordings.get("columns")
    activities = activities_of(content, file, with_nobody=True)
    return RecognitionTask(
        radar=replace(radar, frame_period_s=1 / rate_hz),
        firmware=load_firmware(said),
        activities=activities,
        recordings=RecordingSettings(
            labels=tuple(sorted(activities)),
            window_s=_number(content, "window_s", WINDOW_S, file) or 2.0,
            frame_rate_hz=rate_hz,
            gap_frames=None if gap is None else int(gap),
            columns=None if columns is None else RecordedColumns.of(columns, str(file)),
            empty_label=next((label for label, said in activities.items() if said == (NOBODY,)), None),
        ),
        mount=Mount(
            height_m=_number(mount, "height_m", HEIGHT_M, file), tilt_deg=_number(mount, "tilt_deg", TILT_DEG, file),
            distance_m=_span(mount, "distance_m", DISTANCE_M, file),
        ),
        background=_place(content, "background", file),
        unlabelled=_place(content, "unlabelled", file),
    )  # fmt: skip


def _table(content: dict[str, Any], name: str, file: Path) -> dict[str, Any]:
    table = content.get(name, {})
    if not isinstance(table, dict):
        raise InputError(f"{file}: {name} must be a table, [{name}]")
    _only_known(table, name, file)
    return table


def _only_known(table: dict[str, Any], name: str, file: Path) -> None:
    unknown = [key for key in table if key not in TABLES[name]]
    if unknown:
        where = f" in [{name}]" if name else ""
        raise InputError(f"{file}: {unknown[0]!r}{where} is unknown; known are {', '.join(TABLES[name])}")


def _number(table: dict[str, Any], name: str, limits: tuple[float, float], file: Path) -> float | None:
    value = table.get(name)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not limits[0] <= value <= limits[1]:
        raise InputError(f"{file}: {name} must be a number from {limits[0]:g} to {limits[1]:g}, not {value!r}")
    return float(value)


def _span(table: dict[str, Any], name: str, limits: tuple[float, float], file: Path) -> tuple[float, float] | None:
    value = table.get(name)
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{file}: {name} must be two numbers, [near, far]")
    near, far = (_number({name: one}, name, limits, file) or 0.0 for one in value)
    if near > far:
        raise InputError(f"{file}: {name} = [{near:g}, {far:g}] must rise")
    return near, far


def _place(content: dict[str, Any], name: str, file: Path) -> Path | None:
    said = content.get(name)
    if said is None:
        return None
    if not isinstance(said, str) or not (file.parent / said).exists():
        raise InputError(f"{file}: {name} must name a recording or a folder of them; {said!r} is not there")
    return file.parent / said


def _radar_of(said: str, folder: Path) -> str:
    """A radar file next to the task file, else the words themselves: a preset, or a path from the working folder."""
    name, _ = split_radar(said)
    return str(folder / said) if (folder / name).is_file() else said
