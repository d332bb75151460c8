"""Throughput of `RadarDataset`: CPU seconds an item, each feature by itself, from a labelled set on disk.

Writes results/benchmark/radar_dataset.json in the project's results schema and prints the same as a table.
"""

import os
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from measuring import least_cpu_seconds, report, results_folder

from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.datasets.build_set import SetBuilder, SetOptions
from mmweaver.datasets.radar_dataset import FEATURES, RadarDataset
from mmweaver.weaver.front_door import Weaver

ACTIVITIES: dict[str, tuple[str, ...]] = {"waving": ("a person waves",), "standing": ("a person stands",)}
EACH, SECONDS, REPEATS = 20, 2.0, 2


def item_cpu_s(data: RadarDataset) -> float:
    """CPU seconds an item, over all items."""
    return least_cpu_seconds(lambda: [data[index] for index in range(len(data))], REPEATS) / len(data)


def main() -> int:
    out = results_folder(__doc__)
    values = {}
    with tempfile.TemporaryDirectory() as folder:
        weaver = Weaver()
        SetBuilder(
            Path(folder) / "set", ACTIVITIES, [weaver.sample_room()], weaver,
            SetOptions(each=EACH, seconds=SECONDS), command="make bench", activities_text="",
        ).make()  # fmt: skip
        stored = read_activity_set(Path(folder) / "set")
        for name in FEATURES:
            values[f"{name}_item_cpu_s"] = item_cpu_s(RadarDataset(stored, [name]))
        values["rd_cached_item_cpu_s"] = item_cpu_s(RadarDataset(stored, ["rd", "label"], cached=True))
    dataset = {"name": f"{len(ACTIVITIES) * EACH} sequences of 20 frames, awr1843"}
    report(out, "radar_dataset", dataset, values, {"sequence_length_s": SECONDS})
    return 0


if __name__ == "__main__":
    sys.exit(main())
