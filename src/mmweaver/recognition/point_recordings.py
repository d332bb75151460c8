"""Recordings of a point-cloud radar, generated or real: reading, samples between gaps, windows.

The recordings of a task are in folders named by label, as .npz, .dat or any format that `read_points` reads.
"""

import re
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_arrays import NpzArrays, read_npz
from mmweaver.io.point_clouds.read_points import read_points
from mmweaver.recognition.task_file import RecordedColumns, RecordingSettings

SUFFIXES = (".npz", ".dat", ".csv", ".txt", ".bin")
POINTS_FILE, SIGNAL_FILE = "points.npz", "radar.npz"  # of a result folder of mmweaver generate
SAME_RATE = 0.02
MAX_FRAMES = 10_000_000
BREAK_FRAMES = 100  # between the takes of one file
STILL_MPS = 0.1  # maximum radial speed of a static point
HOLE_S = 10.0  # a longer hole in the frame numbers of a table is missing frames, not an empty room
SURE_HOLE_S, RARELY = 1.0, 0.02  # the same, where the board reports points in nearly every frame; share of the others
MAX_MISSING = 0.2  # maximum share of missing frames in a window


def is_moving(cloud: PointCloud) -> Bool[np.ndarray, " point"]:
    """Mask (point,) of the moving points, by radial velocity."""
    return np.abs(cloud.radial_velocity_mps) > STILL_MPS


@dataclass(frozen=True, kw_only=True)
class PointRecording:
    """Points of frames 0 to num_frames - 1 (including empty frames) at a constant frame rate."""

    name: str
    cloud: PointCloud
    num_frames: int
    frame_rate_hz: float
    label: str = ""  # the activity, if known
    first_frame: int = 0  # within the recording that this is a part of
    missing: Int[np.ndarray, " missing"] = field(default_factory=lambda: np.zeros(0, int))  # frames never received
    joints_m: Float[np.ndarray, "frame 22 3"] | None = None  # of one person in the radar's level axes, if known

    def windows(self, seconds: float, step_s: float | None = None) -> "list[PointRecording]":
        """Windows of equal length; an incomplete last window is dropped.

        Args:
            seconds: Length of a window.
            step_s: Time from one window to the next; by default they are consecutive.
        """
        length = max(round(seconds * self.frame_rate_hz), 1)
        step = max(round((step_s or seconds) * self.frame_rate_hz), 1)
        return [self.part(first, length) for first in range(0, self.num_frames - length + 1, step)]

    def part(self, first: int, num_frames: int) -> "PointRecording":
        """Consecutive frames, renumbered from 0.

        Args:
            first: First frame.
            num_frames: Number of frames.
        """
        inside = (self.cloud.frame >= first) & (self.cloud.frame < first + num_frames)
        cloud = self.cloud.select(inside)
        missing = self.missing[(self.missing >= first) & (self.missing < first + num_frames)]
        return replace(
            self,
            cloud=replace(cloud, frame=cloud.frame - first),
            num_frames=num_frames,
            first_frame=self.first_frame + first,
            missing=missing - first,
            joints_m=None if self.joints_m is None else self.joints_m[first : first + num_frames],
        )


# reading ------------------------------------------------------------------------------------------------------------
def read_task_recordings(
    place: Path | str, settings: RecordingSettings, *, labelled: bool = True
) -> list[PointRecording]:
    """All recordings in a folder and its subfolders, sorted by name; a file is one recording.

    The activity is the name of a folder, or a word of the file's name (`Train_walk_3.npz`).

    Args:
        place: A folder, or one file.
        settings: How the recordings of the task are read.
        labelled: Whether each must name its activity; otherwise labels are empty.

    Returns:
        The recordings, including frames without points.

    Raises:
        InputError: If there are none, or one names no activity or several, or cannot be read.
    """
    place = Path(place)
    check_exists(place, "a folder of recordings")
    files, folder = [place], place.parent
    if place.is_dir():
        found = (path for path in place.rglob("*") if path.suffix.lower() in SUFFIXES and path.is_file())
        files, folder = sorted(path for path in found if not _belongs_to_points_file(path)), place
    if not files:
        raise InputError(f"{place} holds no recordings; {', '.join(SUFFIXES)} are read")
    return [
        read_task_recording(file, settings, _label_of(file, folder, settings.labels) if labelled else "")
        for file in files
    ]


def read_task_recording(file: Path, settings: RecordingSettings, label: str = "") -> PointRecording:
    """One recording, including frames without points.

    Args:
        file: The file, or a result folder.
        settings: How the recordings of the task are read.
        label: The activity, if known.

    Raises:
        InputError: If the file cannot be read.
    """
    if file.is_dir() and (file / POINTS_FILE).is_file():
        file = file / POINTS_FILE
    cloud, frames, missing = _read_cloud(file, settings)
    name = file.parent.name if file.name == POINTS_FILE else file.stem
    frames = frames or settings.window_frames  # without any frame it counts as one window
    if missing is None:
        missing = hole_frames(cloud.frame, settings.frame_rate_hz)
    return PointRecording(
        name=name,
        cloud=cloud,
        num_frames=frames,
        frame_rate_hz=settings.frame_rate_hz,
        label=label,
        missing=missing[missing < frames],
    )


def hole_frames(frame: Int[np.ndarray, " point"], frame_rate_hz: float) -> Int[np.ndarray, " missing"]:
    """Frames that a table of points lacks, as far as its frame numbers tell: those of long holes.

    A table has no rows of a frame without points, nor of one that was lost. An empty room may be silent for some
    seconds, but not where the board reports points in nearly every other frame.

    Args:
        frame: Frame of each point, rising.
        frame_rate_hz: Frames per second.
    """
    held = np.unique(frame)
    between = np.diff(held) - 1
    others = between[between < SURE_HOLE_S * frame_rate_hz]
    is_rare = others.sum() <= RARELY * (others.sum() + len(held))
    is_hole = between >= (SURE_HOLE_S if is_rare else HOLE_S) * frame_rate_hz
    first = held[:-1][is_hole] + 1
    return index_runs(first, first + between[is_hole])[1]


def _label_of(file: Path, folder: Path, labels: tuple[str, ...]) -> str:
    """The activity that a path below `folder` names; InputError if it names none or several."""
    by_folder = [name for name in labels if name in file.relative_to(folder).parts[:-1]]
    words = re.split(r"[^a-z]+", file.stem.lower())
    found = by_folder or [name for name in labels if name == file.stem or name.lower() in words]
    if len(found) != 1:
        raise InputError(f"{file} does not name its activity; put it into a folder named {' or '.join(labels)}")
    return found[0]


def _belongs_to_points_file(file: Path) -> bool:
    """Whether a file is another file of a result folder that has points."""
    return file.name in (SIGNAL_FILE, "pose.npz") and (file.parent / POINTS_FILE).is_file()


def _read_cloud(file: Path, settings: RecordingSettings) -> tuple[PointCloud, int, np.ndarray | None]:
    """Points, number of frames (0 if unknown), and the frames that are known to be missing (None if unknown)."""
    if file.is_dir() and not any(file.glob("*.bin")):
        raise InputError(
            f"{file} holds no {POINTS_FILE}; give a result folder of mmweaver generate, or one recording"
            f" ({', '.join(SUFFIXES)})"
        )
    if file.suffix.lower() == ".npz" and settings.columns is not None:
        held = read_npz(file, only=("frame", "pts", "num_frames", "x_m"))
        if "pts" in held or "x_m" not in held:  # otherwise its columns are named, as in files of `mmweaver points`
            return _from_columns(held, file, settings.columns)
    cloud = read_points(file)
    of_signal = _frames_of_signal(file, settings)
    is_whole = of_signal > 0 or file.name == POINTS_FILE  # of mmWeaver, which loses no frame
    return cloud, max(cloud.num_frames, of_signal), np.zeros(0, int) if is_whole else cloud.missing


def _frames_of_signal(file: Path, settings: RecordingSettings) -> int:
    """The number of frames of the signal in the same result folder; 0 if there is none.

    Raises:
        InputError: If its frame rate is not that of the recogniser's recordings.
    """
    signal = file.with_name(SIGNAL_FILE)
    if file.name != POINTS_FILE or not signal.is_file():
        return 0
    time_s = read_npz(signal, only=("frame_time_s",)).numbers("frame_time_s", ("frame",))
    rate_hz = (len(time_s) - 1) / (time_s[-1] - time_s[0]) if len(time_s) > 1 else settings.frame_rate_hz
    if abs(rate_hz / settings.frame_rate_hz - 1) > SAME_RATE:
        raise InputError(
            f"{file.parent} has {rate_hz:.3g} frames per second, the recogniser's recordings"
            f" {settings.frame_rate_hz:.3g}; generate it at that rate (--fps)"
        )
    return len(time_s)


def _num_frames(frame: np.ndarray) -> int:
    return int(frame[-1]) + 1 if len(frame) else 0


def _from_columns(held: NpzArrays, file: Path, columns: RecordedColumns) -> tuple[PointCloud, int, np.ndarray | None]:
    """`frame` (point,) and `pts` (point, column), perhaps `num_frames`; frames count from the first with points.

    A file that names `num_frames` has all of them.
    """
    frame = held.numbers("frame", ("point",), low=0, high=2**31).astype(int)
    pts = held.numbers("pts", ("point", "column"), low=-1e9, high=1e9).astype(float)
    # where frame numbers restart, another take follows after a break
    before = np.concatenate([frame[:1], frame[:-1]])
    frame = frame + np.cumsum(np.where(frame < before, before - frame + BREAK_FRAMES, 0))
    if "num_frames" in held:  # then frames count from 0
        frames = int(held.numbers("num_frames", (), low=_num_frames(frame), high=MAX_FRAMES))
        return columns.cloud(frame, pts, str(file)), frames, np.zeros(0, int)
    frame = frame - frame[0] if len(frame) else frame
    if _num_frames(frame) > MAX_FRAMES:
        raise InputError(f"{file} has frame numbers up to {frame[-1]}; leave it out")
    return columns.cloud(frame, pts, str(file)), _num_frames(frame), None


# samples and windows ------------------------------------------------------------------------------------------------
def samples_of(recording: PointRecording, gap_frames: int | None) -> list[PointRecording]:
    """Splits a recording at gaps.

    Args:
        recording: The recording.
        gap_frames: Frames without points above which a gap ends a sample; None never splits.
    """
    if gap_frames is None:
        return [recording]
    occupied = np.unique(recording.cloud.frame)
    if not len(occupied):
        return []
    parts = np.split(occupied, np.flatnonzero(np.diff(occupied) - 1 > gap_frames) + 1)
    return [recording.part(int(part[0]), int(part[-1] - part[0]) + 1) for part in parts]


def windows_of(
    recording: PointRecording, settings: RecordingSettings, step_s: float | None = None
) -> list[PointRecording]:
    """Consecutive windows of each sample; a single performance shorter than a window is padded with empty frames.

    Where recordings are never split, the remainder at the end is dropped. If one of the labels is the empty room,
    gaps are samples of it, except in recordings of other labels; otherwise a recording without points is one
    sample, unless samples are single performances. Windows of which more than a fifth is missing are left out.

    Args:
        recording: Frames of one recording.
        settings: Window length, and when a gap ends a sample.
        step_s: Time from one window to the next; by default they are consecutive.

    Returns:
        Windows in the order of their first frames.
    """
    windows: list[PointRecording] = []
    samples = samples_of(recording, settings.gap_frames)
    for sample in samples:
        whole = sample.windows(settings.window_s, step_s)
        if not whole and settings.has_single_performances:
            whole = [sample.part(0, settings.window_frames)]
        windows += whole
    if settings.empty_label is not None and recording.label in ("", settings.empty_label):
        silent = _silences(recording, samples)
    else:
        silent = [] if samples or settings.has_single_performances else [recording]
    windows += [window for one in silent for window in one.windows(settings.window_s, step_s)]
    windows = [window for window in windows if len(window.missing) <= MAX_MISSING * window.num_frames]
    return sorted(windows, key=lambda window: window.first_frame)


def _silences(recording: PointRecording, samples: list[PointRecording]) -> list[PointRecording]:
    """The gaps between samples, before the first and after the last."""
    firsts = [one.first_frame - recording.first_frame for one in samples]
    begins = [0, *(first + one.num_frames for first, one in zip(firsts, samples, strict=True))]
    ends = [*firsts, recording.num_frames]
    return [recording.part(begin, end - begin) for begin, end in zip(begins, ends, strict=True) if end > begin]


def index_runs(
    begin: Int[np.ndarray, " run"], end: Int[np.ndarray, " run"]
) -> tuple[Int[np.ndarray, " index"], Int[np.ndarray, " index"]]:
    """Concatenated index ranges.

    Args:
        begin: First index (run,) of each range.
        end: Index (run,) after the last.

    Returns:
        Number of the range (index,), and the index (index,).
    """
    count = end - begin
    run = np.repeat(np.arange(len(count)), count)
    return run, np.arange(len(run)) - np.repeat(np.cumsum(count) - count - begin, count)
