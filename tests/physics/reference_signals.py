"""A short signal by each method, and some of its cells as one processor computed them: reference_signals.npz.

Where a change is meant to move signals, the cells are computed anew: python -m tests.physics.reference_signals
"""

from pathlib import Path

import numpy as np

from mmweaver import Weaver
from mmweaver.core.boards import AWR1843
from mmweaver.core.records import PoseSequence
from mmweaver.core.stages import Stages
from mmweaver.models.methods import METHODS, Physics
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward
from mmweaver.propagation.static_paths import Propagation

FILE = Path(__file__).with_suffix(".npz")
SPEED_MPS, FRAMES, CELLS = 0.8, 2, 200
# Difference of a cell over the peak; between kinds of processors at most 8e-6 was measured for physics.
TOLERANCE = {"physics": 1.6e-5, "physics_first_order": 1.6e-5, "weaver": 2.5e-4}


def walking() -> PoseSequence:
    """The mean skeleton that glides towards the radar, upright: a motion that no change of the composer moves."""
    time_s = np.arange(60) / 120
    still = forward(np.zeros((1, 22, 3)), np.zeros((1, 3)), MEAN_OFFSET_M)[0][:, [2, 0, 1]]
    place_m = np.array([0.2, 2.6, -0.25]) - SPEED_MPS * time_s[:, None] * np.array([0.0, 1.0, 0.0])
    joints_m = (still + place_m[:, None]).astype(np.float32)
    return PoseSequence(time_s=time_s, joints_m=joints_m, height_m=1.7, subject=3)


def signal(method: str) -> np.ndarray:
    """The cube of two frames in the bundled room, complex64 (frame, range, doppler, antenna), over its peak."""
    room = Weaver(method="physics").sample_room()
    first_order = Physics(Propagation(bounces=1, clutter=False))
    made = first_order if method == "physics_first_order" else METHODS[method]()
    cube = made(
        room.scene, (walking(),), AWR1843, num_frames=FRAMES, seed=5, keep_adc=False, stages=Stages()
    ).cube.values  # fmt: skip
    return cube / np.abs(cube).max()


def chosen(values: np.ndarray) -> np.ndarray:
    """The flat numbers of cells: half of them strongest, half evenly spread over the cube."""
    flat = np.abs(values).ravel()
    return np.concatenate(
        [np.argsort(flat, kind="stable")[-CELLS // 2 :], np.linspace(0, flat.size - 1, CELLS // 2)]
    ).astype(int)


def main() -> None:
    """Writes the file."""
    arrays = {}
    for method in TOLERANCE:
        values = signal(method)
        cells = chosen(values)
        arrays |= {f"{method}_cell": cells.astype(np.int32), f"{method}_value": values.ravel()[cells]}
    np.savez_compressed(FILE, **arrays)


if __name__ == "__main__":
    main()
