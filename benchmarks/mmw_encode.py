"""What compressing a cube to a size costs, in CPU-seconds a frame: people in the sample room, and recordings.

python benchmarks/mmw_encode.py [--data <recordings>]

Writes results/benchmark/mmw_encode.json in the project's results schema and prints the same as a table.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

import torch
from measuring import RESULTS, least_cpu_seconds, report

from mmweaver.compression.mmw_codec import compress_cube
from studies.fields.field_signals import RECORDED, SIGNALS

SIZES = {"2500": 2504, "10_000": 10018, "40_000": 40072}  # bytes
REPEATS = 3
WITHOUT_WALKERS = ("breathing",)


def encode_costs(data: Path | None) -> dict[str, float]:
    """CPU-seconds a frame for each size; the mean and the most over cubes of people who move about."""
    names = [name for name in SIGNALS if name not in WITHOUT_WALKERS and (data or name not in RECORDED)]
    costs: dict[str, float] = {}
    for label, size in SIZES.items():
        for name in names:
            cube = SIGNALS[name](data).cube
            seconds = least_cpu_seconds(partial(compress_cube, cube, num_bytes=size), REPEATS)
            costs[f"{name}_{label}_bytes_cpu_s"] = seconds / len(cube.values)
        own = [costs[f"{name}_{label}_bytes_cpu_s"] for name in names]
        costs[f"mean_{label}_bytes_cpu_s"], costs[f"most_{label}_bytes_cpu_s"] = sum(own) / len(own), max(own)
    return costs


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=RESULTS)
    parser.add_argument("--data", type=Path, default=None, help="folder of recordings (with radar/ in it)")
    options = parser.parse_args()
    torch.set_num_threads(1)
    dataset = {"name": "20 frames of people who move about, 64 x 32 cells of 8 or 12 antennas"}
    report(options.out, "mmw_encode", dataset, encode_costs(options.data), {"unit": "CPU-seconds a frame"})
    return 0


if __name__ == "__main__":
    sys.exit(main())
