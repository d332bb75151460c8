""".npy arrays of points, a stack of equal frames filled up with zeros: MARS's 8 x 8 x 5, mRI's 14 x 14 x 5, (frame,
point, 5) of others. The last axis holds x, y, z, Doppler and intensity.

Reference: An and Ogras, MARS (featuremap_*.npy); An et al., mRI (pose estimation features).
"""

from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.io.point_clouds.point_log import LoggedCloud, logged_cloud, point_format

COLUMNS = 5
MAX_BYTES = 2_000_000_000


def _is_stack(path: Path, head: bytes) -> bool:
    if path.suffix.lower() != ".npy":
        return False
    array = read_npy(path, mapped=True)
    return array.ndim in (3, 4) and array.shape[-1] == COLUMNS and array.dtype.kind == "f"


@point_format("arrays", ".npy of (frame, point, 5) or (frame, row, column, 5) (MARS, mRI)", _is_stack)
def read_point_arrays(path: Path) -> LoggedCloud:
    """Reads a stack of frames.

    Args:
        path: The file. Points of which every number is 0 fill a frame up and are left out.

    Returns:
        The cloud, with intensity.

    Raises:
        InputError: If the array has another shape or type.
    """
    array = read_npy(path, mapped=True)
    if array.ndim not in (3, 4) or array.shape[-1] != COLUMNS or array.dtype.kind != "f":
        raise InputError(f"{path} holds {array.dtype} of shape {array.shape}; points are (frame, ..., 5): x, y, z,"
                         " Doppler, intensity")  # fmt: skip
    if not array.size:
        raise InputError(f"{path} is empty: its shape is {array.shape}")
    if array.nbytes > MAX_BYTES:
        raise InputError(f"{path} holds {array.nbytes / 1e9:.1f} GB; at most {MAX_BYTES / 1e9:.0f} GB are read at once")
    points = np.asarray(array, float).reshape(len(array), -1, COLUMNS)
    frame, row = np.nonzero((points != 0).any(axis=2))
    table = points[frame, row]
    return logged_cloud(frame, table[:, :3], table[:, 3], intensity=table[:, 4], num_frames=len(array))
