"""Recordings of a task: folders named by label, of .npz, .dat or whatever `read_points` reads; samples and windows."""

import re
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_arrays import NpzArrays, read_npz
from mmweaver.formats.point_clouds.read_points import read_points
from mmweaver.formats.point_clouds.ti_uart import read_ti_uart
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.recorded_columns import RecordedColumns
from mmweaver.recognition.task_file import RecordingSettings

SUFFIXES = (".npz", ".dat", ".csv", ".txt", ".bin")
MOST_FRAMES = 10_000_000
BREAK_FRAMES = 100  # between the takes of one file


def read_task_recordings(
    place: Path | str, settings: RecordingSettings, *, labelled: bool = True
) -> list[PointRecording]:
    """All recordings in a folder and its subfolders, sorted by name; a file is one recording.

    The activity is the name of a folder, or a word of the file's name (`Train_walk_3.npz`). Raises InputError where
    there are none, one names no activity or several, or cannot be read.
    """
    place = Path(place)
    check_exists(place, "a folder of recordings")
    files = [place]
    if place.is_dir():
        files = sorted(path for path in place.rglob("*") if path.suffix.lower() in SUFFIXES and path.is_file())
    if not files:
        raise InputError(f"{place} holds no recordings; {', '.join(SUFFIXES)} are read")
    folder = place if place.is_dir() else place.parent
    return [
        read_task_recording(file, settings, label_of(file, folder, settings.labels) if labelled else "")
        for file in files
    ]


def read_task_recording(file: Path, settings: RecordingSettings, label: str = "") -> PointRecording:
    """One recording; frames without points count. Raises InputError for a file that cannot be read."""
    cloud, frames = _cloud(file, settings.columns)
    return PointRecording(
        name=file.stem, cloud=cloud, num_frames=frames, frame_rate_hz=settings.frame_rate_hz, label=label
    )


def label_of(file: Path, folder: Path, labels: tuple[str, ...]) -> str:
    """The activity that a path below `folder` names. Raises InputError where it names none or several."""
    inside = file.relative_to(folder)
    by_folder = [name for name in labels if name in inside.parts[:-1]]
    words = re.split(r"[^a-z]+", file.stem.lower())
    found = by_folder or [name for name in labels if name == file.stem or name.lower() in words]
    if len(found) != 1:
        raise InputError(f"{file} does not name its activity; put it into a folder named {' or '.join(labels)}")
    return found[0]


def _cloud(file: Path, columns: RecordedColumns | None) -> tuple[PointCloud, int]:
    if file.suffix.lower() == ".npz" and columns is not None:
        held = read_npz(file, only=("frame", "pts", "num_frames", "x_m"))
        if "pts" in held or "x_m" not in held:  # else it names its columns itself, as `mmweaver points` writes them
            return _from_columns(held, file, columns)
    if file.suffix.lower() == ".dat":
        log = read_ti_uart(file)
        return log.points, max(len(log.frame_number), 1)
    cloud = read_points(file)
    return cloud, _num_frames(cloud.frame)


def _num_frames(frame: np.ndarray) -> int:
    return int(frame[-1]) + 1 if len(frame) else 0


def _from_columns(held: NpzArrays, file: Path, columns: RecordedColumns) -> tuple[PointCloud, int]:
    """`frame` (point,) and `pts` (point, column), perhaps `num_frames`; frames count from the first with points."""
    frame = held.numbers("frame", ("point",), low=0, high=2**31).astype(int)
    pts = held.numbers("pts", ("point", "column"), low=-1e9, high=1e9).astype(float)
    frame = _takes_in_turn(frame)
    if "num_frames" in held:  # then frames count from 0
        frames = int(held.numbers("num_frames", (), low=_num_frames(frame), high=MOST_FRAMES))
        return columns.cloud(frame, pts, str(file)), frames
    frame = frame - frame[0] if len(frame) else frame
    if _num_frames(frame) > MOST_FRAMES:
        raise InputError(f"{file} has frame numbers up to {frame[-1]}; leave it out")
    return columns.cloud(frame, pts, str(file)), _num_frames(frame)


def _takes_in_turn(frame: np.ndarray) -> np.ndarray:
    """Frame numbers (point,) that never fall: where a log begins to count again, another take follows after a break."""
    falls = np.diff(frame, prepend=frame[:1]) < 0
    before = np.concatenate([[0], frame[:-1]])
    return frame + np.cumsum(np.where(falls, before - frame + BREAK_FRAMES, 0))


# samples and windows ------------------------------------------------------------------------------------------------
def samples_of(recording: PointRecording, gap_frames: int | None) -> list[PointRecording]:
    """The parts of a recording between gaps: more than `gap_frames` frames without points. None: never cut."""
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
    """Consecutive windows of each sample; one that is shorter than a window is a window with empty frames at its end.

    Where recordings are never cut, what is left over at the end is dropped. A recording without any point, of an empty
    place, is one sample, unless samples are single performances. `step_s`: every so often a window begins.
    """
    windows: list[PointRecording] = []
    samples = samples_of(recording, settings.gap_frames)
    if not samples and not settings.has_single_performances:
        samples = [recording]
    for sample in samples:
        whole = sample.windows(settings.window_s, step_s)
        if not whole and settings.has_single_performances:
            whole = [sample.part(0, settings.window_frames)]
        windows += whole
    return windows
