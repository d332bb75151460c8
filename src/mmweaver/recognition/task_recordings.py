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
POINTS_FILE, SIGNAL_FILE = "points.npz", "radar.npz"  # of a result folder of mmweaver generate
RESULT_FILES = (SIGNAL_FILE, "pose.npz")
SAME_RATE = 0.02
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
        files = sorted(
            path for path in place.rglob("*")
            if path.suffix.lower() in SUFFIXES and path.is_file() and not _belongs_to_points_file(path)
        )  # fmt: skip
    if not files:
        raise InputError(f"{place} holds no recordings; {', '.join(SUFFIXES)} are read")
    folder = place if place.is_dir() else place.parent
    return [
        read_task_recording(file, settings, label_of(file, folder, settings.labels) if labelled else "")
        for file in files
    ]


def read_task_recording(file: Path, settings: RecordingSettings, label: str = "") -> PointRecording:
    """One recording; frames without points count. Raises InputError for a file that cannot be read."""
    if file.is_dir() and (file / POINTS_FILE).is_file():
        file = file / POINTS_FILE
    cloud, frames = _cloud(file, settings)
    name = file.parent.name if file.name == POINTS_FILE else file.stem
    return PointRecording(name=name, cloud=cloud, num_frames=frames, frame_rate_hz=settings.frame_rate_hz, label=label)


def label_of(file: Path, folder: Path, labels: tuple[str, ...]) -> str:
    """The activity that a path below `folder` names. Raises InputError where it names none or several."""
    inside = file.relative_to(folder)
    by_folder = [name for name in labels if name in inside.parts[:-1]]
    words = re.split(r"[^a-z]+", file.stem.lower())
    found = by_folder or [name for name in labels if name == file.stem or name.lower() in words]
    if len(found) != 1:
        raise InputError(f"{file} does not name its activity; put it into a folder named {' or '.join(labels)}")
    return found[0]


def _belongs_to_points_file(file: Path) -> bool:
    """Whether a file is another one of a result folder that has points."""
    return file.name in RESULT_FILES and (file.parent / POINTS_FILE).is_file()


def _cloud(file: Path, settings: RecordingSettings) -> tuple[PointCloud, int]:
    columns = settings.columns
    if file.is_dir() and not any(file.glob("*.bin")):
        raise InputError(
            f"{file} holds no {POINTS_FILE}; give a result folder of mmweaver generate, or one recording"
            f" ({', '.join(SUFFIXES)})"
        )
    if file.suffix.lower() == ".npz" and columns is not None:
        held = read_npz(file, only=("frame", "pts", "num_frames", "x_m"))
        if "pts" in held or "x_m" not in held:  # else it names its columns itself, as `mmweaver points` writes them
            return _from_columns(held, file, columns, settings.window_frames)
    if file.suffix.lower() == ".dat":
        log = read_ti_uart(file)
        return log.points, max(len(log.frame_number), 1)
    cloud = read_points(file)
    frames = max(_num_frames(cloud.frame), _frames_of_signal(file, settings))
    return cloud, frames or settings.window_frames  # without any frame it lasts a window, for all that is known


def _frames_of_signal(file: Path, settings: RecordingSettings) -> int:
    """The number of frames of the signal in the same result folder; 0 where there is none.

    Raises InputError where it has another frame rate than the recogniser's recordings.
    """
    signal = file.with_name(SIGNAL_FILE)
    if file.name != POINTS_FILE or not signal.is_file():
        return 0
    time_s = read_npz(signal, only=("frame_time_s",)).numbers("frame_time_s", ("frame",))
    rate_hz = (len(time_s) - 1) / (time_s[-1] - time_s[0]) if len(time_s) > 1 else settings.frame_rate_hz
    if abs(rate_hz / settings.frame_rate_hz - 1) > SAME_RATE:
        raise InputError(
            f"{file.parent} has {rate_hz:.3g} frames a second, the recogniser's recordings"
            f" {settings.frame_rate_hz:.3g}; generate it at that rate (--fps)"
        )
    return len(time_s)


def _num_frames(frame: np.ndarray) -> int:
    return int(frame[-1]) + 1 if len(frame) else 0


def _from_columns(held: NpzArrays, file: Path, columns: RecordedColumns, window_frames: int) -> tuple[PointCloud, int]:
    """`frame` (point,) and `pts` (point, column), perhaps `num_frames`; frames count from the first with points.

    Without points and `num_frames` it lasts a window, for all that is known.
    """
    frame = held.numbers("frame", ("point",), low=0, high=2**31).astype(int)
    pts = held.numbers("pts", ("point", "column"), low=-1e9, high=1e9).astype(float)
    frame = _takes_in_turn(frame)
    if "num_frames" in held:  # then frames count from 0
        frames = int(held.numbers("num_frames", (), low=_num_frames(frame), high=MOST_FRAMES))
        return columns.cloud(frame, pts, str(file)), frames
    frame = frame - frame[0] if len(frame) else frame
    if _num_frames(frame) > MOST_FRAMES:
        raise InputError(f"{file} has frame numbers up to {frame[-1]}; leave it out")
    return columns.cloud(frame, pts, str(file)), _num_frames(frame) or window_frames


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

    Where recordings are never cut, what is left over at the end is dropped. Where one of the labels is an empty place,
    gaps are samples of it, but for those of recordings of other labels; else a recording without any point is one
    sample, unless samples are single performances. `step_s`: every so often a window begins.
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
    return sorted(windows, key=lambda window: window.first_frame)


def _silences(recording: PointRecording, samples: list[PointRecording]) -> list[PointRecording]:
    """What lies between samples, before the first and after the last, without points."""
    begins = [0, *(one.first_frame - recording.first_frame + one.num_frames for one in samples)]
    ends = [*(one.first_frame - recording.first_frame for one in samples), recording.num_frames]
    return [recording.part(begin, end - begin) for begin, end in zip(begins, ends, strict=True) if end > begin]
