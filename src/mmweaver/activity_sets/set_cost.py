"""Estimated cost of a labelled set before it is made."""

from collections import Counter

from mmweaver.activity_sets.build_set import SetBuilder
from mmweaver.datasets.dataset_cost import BENCHMARK_FRAMES, DatasetCost

# CPU seconds of 20 frames by method, composing included; 300 sequences of ten activities, other machines differ
SEQUENCE_S = {"weaver": 0.12, "physics": 0.4}
ON_DEMAND_BYTES = 75_000.0  # of 30 frames without signals
BYTES = {"float16": 4.0, "float32": 8.0}  # of a complex value


def estimate_set_cost(builder: SetBuilder) -> DatasetCost:
    """Cost of the sequences that are missing. Raises InputError where no place serves an activity."""
    missing = len(builder.plan) - builder.finished
    request = builder.request_of(builder.plan[0])
    config, frames = request.config, request.frames
    values = frames * config.num_range_bins * config.num_loops * config.num_antennas
    each = ON_DEMAND_BYTES * frames / 30 if builder.options.iq == "none" else BYTES[builder.options.iq] * values
    seconds = SEQUENCE_S.get(builder.weaver.method_name, SEQUENCE_S["weaver"])
    return DatasetCost(
        rooms=len(builder.rooms), sequences=missing, core_s=missing * frames / BENCHMARK_FRAMES * seconds,
        disk_bytes=missing * each,
        splits=dict(Counter(builder.splits[builder.options.split_by]).most_common()),
    )  # fmt: skip
