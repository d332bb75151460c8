"""Items a CPU second of `RadarDataset`, each feature by itself, from a labelled set on disk.

Writes results/benchmark/radar_dataset.json in the project's results schema and prints the same as a table.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from measuring import report, results_folder

from mmweaver.activity_sets.activity_list import ActivityList
from mmweaver.activity_sets.build_set import SetBuilder, SetOptions
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.datasets.radar_dataset import FEATURES, RadarDataset
from mmweaver.generate import Weaver

ACTIVITIES = {"waving": ("a person waves",), "standing": ("a person stands",)}
EACH, SECONDS = 20, 2.0


def items_a_cpu_second(data: RadarDataset) -> float:
    """All items once."""
    start = time.process_time()
    for index in range(len(data)):
        data[index]
    return len(data) / (time.process_time() - start)


def main() -> int:
    out = results_folder(__doc__)
    values = {}
    with tempfile.TemporaryDirectory() as folder:
        weaver = Weaver()
        SetBuilder(
            Path(folder) / "set", ActivityList(sentences=ACTIVITIES), [weaver.sample_room()], weaver,
            SetOptions(each=EACH, seconds=SECONDS), command="make bench", activities_text="",
        ).make()  # fmt: skip
        stored = read_activity_set(Path(folder) / "set")
        for name in FEATURES:
            values[f"{name}_items_a_cpu_s"] = items_a_cpu_second(RadarDataset(stored, [name]))
        cached = RadarDataset(stored, ["rd", "label"], cached=True)
        items_a_cpu_second(cached)
        values["rd_cached_items_a_cpu_s"] = items_a_cpu_second(cached)
    dataset = {"name": f"{len(ACTIVITIES) * EACH} sequences of 20 frames, awr1843"}
    report(out, "radar_dataset", dataset, values, {"seconds": SECONDS})
    return 0


if __name__ == "__main__":
    sys.exit(main())
