"""What sampling the paper's INR on a whole 20-frame cube costs, as ratios measured in one run.

Writes results/benchmark/inr_decode.json in the project's results schema and prints the same as a table.
"""

import sys

import numpy as np
import torch
from measuring import least_cpu_seconds, least_seconds, report, results_folder

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid
from mmweaver.inr import InrField, ModulatedINR

NUM_FRAMES = 20
REPEATS = 30  # so many that some run finds the machine free


def decode_costs() -> dict[str, float]:
    grid = CubeGrid.of(AWR1843, NUM_FRAMES)
    field = InrField(ModulatedINR(NUM_FRAMES), config=AWR1843, grid=grid, scale=1.0, amplitude=1.0, is_centred=True)
    every = np.indices(grid.shape).reshape(4, -1).T.astype(np.float64)
    exact, fast = field.sample(every).reshape(grid.shape), field.cube().values
    seconds = {
        "point_by_point_s": least_seconds(lambda: field.sample(every), 1),
        "on_axes_s": least_seconds(field.cube, REPEATS),
        "on_axes_cpu_s": least_cpu_seconds(field.cube, REPEATS),
    }
    # processor time on both sides of the ratio: other work on the machine hardly touches it
    a = torch.ones(2048, 2048)
    gemm_flop_per_s = 2 * 2048**3 / least_cpu_seconds(lambda: a @ a, 8)
    flop = 2 * every.shape[0] * (3 * 32 * 32 + 32 * 2)
    return {
        **seconds,
        "gemm_gflop_per_s": gemm_flop_per_s / 1e9,
        "times_gemm_limit": seconds["on_axes_cpu_s"] / (flop / gemm_flop_per_s),
        "times_faster_than_point_by_point": seconds["point_by_point_s"] / seconds["on_axes_s"],
        "error": float(np.abs(fast - exact).max() / np.abs(exact).max()),
    }


def main() -> int:
    out = results_folder(__doc__)
    torch.set_num_threads(1)
    dataset = {"name": "20 frames of the awr1843 cube, 64 x 32 x 12", "points": NUM_FRAMES * 64 * 32 * 12}
    report(out, "inr_decode", dataset, decode_costs(), {"threads": "1"})
    return 0


if __name__ == "__main__":
    sys.exit(main())
