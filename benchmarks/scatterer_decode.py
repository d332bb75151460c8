"""What rendering a scatterer field on a whole 20-frame cube costs, as ratios measured in one run.

Writes results/benchmark/scatterer_decode.json in the project's results schema and prints the same as a table.
"""

import sys
from functools import partial

import torch
from measuring import least_cpu_seconds, least_seconds, report, results_folder

from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.layers import Layers
from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid
from mmweaver.signal.point_response import Points

NUM_FRAMES = 20
REPEATS = 200  # so many that some run finds the machine free


def field_of(num_points: int) -> ScattererField:
    """So many scatterers in each frame, anywhere."""
    generator = torch.Generator().manual_seed(0)

    def uniform(low: float, high: float, *more: int) -> torch.Tensor:
        return low + (high - low) * torch.rand(NUM_FRAMES, num_points, *more, generator=generator)

    points = Points(
        range_bin=uniform(16.0, 79.0), doppler_bin=uniform(-15.0, 15.0), direction=uniform(-0.6, 0.6, 2),
        amplitude=torch.polar(uniform(0.1, 1.0), uniform(0.0, 6.28)),
    )  # fmt: skip
    layers = Layers(
        points=points, static=torch.ones(64, 12, dtype=torch.complex64),
        calibration=torch.ones(12, dtype=torch.complex64), noise_power=1e-6,
    )  # fmt: skip
    return ScattererField(layers, FitWindow.of(AWR1843, NUM_FRAMES, 0), CubeGrid.of(AWR1843, NUM_FRAMES), 1.0, 1.0)


def decode_costs() -> dict[str, float]:
    costs: dict[str, float] = {}
    field = field_of(50)
    for num_points in (50, 83):
        field = field_of(num_points)
        for threads in (1, 4):
            costs[f"{num_points}_points_{threads}_threads_s"] = least_seconds(partial(field.native, threads), REPEATS)
        costs[f"{num_points}_points_cpu_s"] = least_cpu_seconds(partial(field.native, 1), REPEATS)
    # processor time on both sides of the ratio: other work on the machine hardly touches it
    a = torch.ones(2048, 2048)
    gemm_flop_per_s = 2 * 2048**3 / least_cpu_seconds(lambda: a @ a, 8)
    # range x (2 points) x (doppler, antenna, re and im), real
    flop = 2 * NUM_FRAMES * 64 * (2 * 83) * (32 * 12 * 2)
    costs["gemm_gflop_per_s"] = gemm_flop_per_s / 1e9
    costs["times_gemm_limit_83_points"] = costs["83_points_cpu_s"] / (flop / gemm_flop_per_s)
    return costs


def main() -> int:
    out = results_folder(__doc__)
    torch.set_num_threads(1)
    dataset = {"name": "20 frames of the awr1843 cube, 64 x 32 x 12", "points": NUM_FRAMES * 64 * 32 * 12}
    report(out, "scatterer_decode", dataset, decode_costs(), {"threads": "as the names say, else 1"})
    return 0


if __name__ == "__main__":
    sys.exit(main())
