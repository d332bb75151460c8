"""Recordings and results in files and folders: those offered by the command line, and those uploaded to a session."""

from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.regular_files import check_regular
from mmweaver.io.capture_std import is_capture
from mmweaver.io.point_clouds.ti_uart import read_ti_uart
from mmweaver.io.radar_file import load_radar
from mmweaver.io.stored_result import read_result
from mmweaver.io.stream_folder import is_stream
from mmweaver.recordings.processing import process_recording
from mmweaver.studio.sessions import Result

PORT_LOG_PERIOD_S = 0.1  # of a data port's log without its .cfg
SETTINGS = (".cfg", ".json")
ALONE = (".dat", ".npy", ".npz")  # files that are readable without a .cfg
NONE_FOUND = "holds no recording: no radar.npz, .bin with its .cfg, capture, stream or .dat"


def read_offered(path: Path) -> Result:
    """Reads a recording.

    Raises:
        InputError: If there is none, or it cannot be read.
    """
    found = read_recorded(path)
    if found is None:
        raise InputError(f"{path} {NONE_FOUND}")
    return found


def check_offered(path: Path) -> None:
    """Checks that a path contains a recording.

    Raises:
        InputError: If it does not.
    """
    if path.is_dir():
        if not _is_result_or_capture(path) and not any(_samples_or_log(path)):
            raise InputError(f"{path} {NONE_FOUND}")
    elif not check_regular(path):
        raise InputError(f"{path} is empty")
    elif path.suffix.lower() not in ALONE:
        raise InputError(f"{path}: give a folder that holds it with its .cfg; only {', '.join(ALONE)} are read alone")


def _is_result_or_capture(folder: Path) -> bool:
    return (folder / "radar.npz").is_file() or is_capture(folder) or is_stream(folder)


def _samples_or_log(folder: Path) -> list[Path]:
    """Raw samples and logs of a data port in a folder, samples first."""
    inside = sorted(folder.iterdir())
    return [file for suffix in (".bin", ".dat") for file in inside if file.suffix.lower() == suffix]


def read_recorded(path: Path, radar: RadarConfig | None = None) -> Result | None:
    """Reads a recording or a result: a result folder, raw samples, a capture, or a data port's log.

    Args:
        path: File or folder.
        radar: Radar of raw samples that have no .cfg.

    Returns:
        The recording; None if the folder contains none of these.

    Raises:
        InputError: If it cannot be read.
    """
    if path.is_file():
        return _of_file(path, None, radar)
    if (path / "radar.npz").is_file() and (path / "points.npz").is_file():
        stored = read_result(path)
        return Result(cube=stored.cube, points=stored.points, poses=stored.poses, meta=_named(stored.meta, path.name))
    if _is_result_or_capture(path):
        return _processed(path, None)
    settings = next((file for file in sorted(path.iterdir()) if file.suffix.lower() in SETTINGS), None)
    return next((_of_file(file, settings, radar) for file in _samples_or_log(path)), None)


def _of_file(file: Path, settings: Path | None, radar: RadarConfig | None) -> Result:
    if file.suffix.lower() == ".dat":
        return _port_log(file, settings)
    return _processed(file, radar if settings is None else settings)


def _processed(path: Path, radar: RadarConfig | Path | None) -> Result:
    done = process_recording(path, str(radar) if isinstance(radar, Path) else radar)
    return Result(cube=done.cube, points=done.points, poses=(), meta=_named(done.meta, path.name))


def _port_log(file: Path, settings: Path | None) -> Result:
    """The point cloud that a TI board sent over its data port; the frame rate is that of its .cfg."""
    log = read_ti_uart(file)
    config = None if settings is None else load_radar(str(settings))
    period_s = PORT_LOG_PERIOD_S if config is None else config.frame_period_s
    assumed = [f"The log brings no .cfg: {1 / period_s:g} frames a second were taken."] if config is None else []
    assumed += [f"{note[0].upper()}{note[1:]}." for note in log.points.notes]
    meta = {"text": file.name, "points": "firmware", "frames": log.points.num_frames, "assumed": assumed}
    radar = "data port of a TI board" if config is None else config.name
    return Result(cube=None, points=log.points, poses=(), meta=meta, frame_period_s=period_s, radar=radar)


def _named(meta: dict, name: str) -> dict:
    return {**meta, "text": meta.get("text") or name}
