"""replay_N.json of TI's Applications Visualizer (before: Industrial Visualizer), which logs what it shows.

A list `data` of packets, each with `frameData` and a `timestamp` in milliseconds of the PC. `pointCloud` has a row per
point: x, y, z in m, Doppler in m/s, SNR and noise in dB, and the number of the track (255: none). Older logs are pairs
of frame and points in the same order. `frameNum` counts the frames of the board, so that lost packets are known.

Reference: mmWave radar toolbox, Applications_Visualizer, common/parseTLVs.py and Demo_Classes (fields of outputDict).
"""

from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.io.point_clouds.point_log import LoggedCloud, counted_frames, logged_cloud, point_format

COLUMNS = 5  # x, y, z, Doppler, SNR; noise and track follow


def _is_replay(path: Path, head: bytes) -> bool:
    return path.suffix.lower() == ".json" and b'"data"' in head and b'"frameData"' in head


@point_format("ti_replay", "replay_*.json of TI's Visualizer", _is_replay)
def read_ti_replay(path: Path) -> LoggedCloud:
    """Reads a log of the Visualizer.

    Args:
        path: The file.

    Returns:
        The cloud, with SNR; frames that the board counted but the log lacks are without points.

    Raises:
        InputError: If it is malformed or no packet has a point cloud.
    """
    values = read_json(path)
    try:
        packets = [one["frameData"] for one in values["data"]]
        clouds = [_points(packet) for packet in packets if "pointCloud" in packet]
        numbers = [int(packet["frameNum"]) for packet in packets if "pointCloud" in packet and "frameNum" in packet]
    except (KeyError, TypeError, ValueError, IndexError, OverflowError, AttributeError) as error:
        raise InputError(f"{path} is no replay of TI's Visualizer: a packet of it is malformed ({error})") from None
    if not clouds:
        raise InputError(f"{path} holds {len(packets)} packets of TI's Visualizer, but no point cloud in them")
    counted = counted_frames(np.array(numbers if len(numbers) == len(clouds) else range(len(clouds))))
    table = np.concatenate(clouds)
    return logged_cloud(
        np.repeat(counted.frame, [len(cloud) for cloud in clouds]),
        table[:, :3],
        table[:, 3],
        snr_db=table[:, 4],
        num_frames=counted.num_frames,
        notes=counted.notes,
        missing=counted.missing,
    )


def _points(packet: Any) -> np.ndarray:
    """Rows of x, y, z, Doppler, SNR; SNR is nan where a demo sends none."""
    rows = [[float(value) for value in row[:COLUMNS]] for row in packet["pointCloud"]]
    if any(len(row) < COLUMNS - 1 for row in rows):
        raise ValueError("a point has fewer than four numbers")
    return np.array([[*row, np.nan][:COLUMNS] for row in rows], float).reshape(-1, COLUMNS)
