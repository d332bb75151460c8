"""A stream of sentences: how soon the first frame comes, how fast frames go on, and whether memory grows.

Two processes: the first asks a warm weaver for single frames of new streams, the second makes a long stream, reads its
own memory every minute of signal, and drops the chunks. Writes results/benchmark/stream.json and prints the same.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import count
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measuring import RESULTS, report

SENTENCES = (
    "a person walks to the left, then waves", "she claps", "a person sits down", "he stands up and boxes",
    "a person walks towards the radar", "a person squats three times", "a person turns around",
)  # fmt: skip
MINUTES, FIRSTS = 20.0, 12
WARM_MINUTES = 2  # of the stream, before memory counts


def endless() -> Iterator[str]:
    """The sentences again and again."""
    return (SENTENCES[number % len(SENTENCES)] for number in count())


def first_frames() -> dict[str, float]:
    """Seconds from a sentence to the first frame of a new stream, the room known and the weaver warm."""
    from mmweaver import Weaver

    weaver = Weaver()
    room = weaver.sample_room()
    cpu_s, wall_s = [], []
    for seed in range(FIRSTS + 1):
        cpu, wall = time.process_time(), time.perf_counter()
        next(iter(weaver.stream(room, [SENTENCES[seed % len(SENTENCES)]], seed=seed, chunk_frames=1)))
        cpu_s.append(time.process_time() - cpu)
        wall_s.append(time.perf_counter() - wall)
    return {
        "first_frame_median_cpu_s": float(np.median(cpu_s[1:])), "first_frame_slowest_cpu_s": max(cpu_s[1:]),
        "first_frame_median_wall_s": float(np.median(wall_s[1:])), "first_frame_slowest_wall_s": max(wall_s[1:]),
    }  # fmt: skip


def long_stream(minutes: float) -> dict[str, float]:
    """Speed and memory of a stream of some minutes of signal."""
    from mmweaver import Weaver

    weaver = Weaver()
    room = weaver.sample_room()
    seconds, memory_gb, minute = 0.0, [], 0
    cpu, wall = time.process_time(), time.perf_counter()
    for chunk in weaver.stream(room, endless(), seed=0):
        seconds += chunk.num_frames * chunk.cube.config.frame_period_s
        if seconds >= 60 * (minute + 1):
            minute += 1
            memory_gb.append(_resident_gb())
        if seconds >= 60 * minutes:
            break
    spent_cpu, spent_wall = time.process_time() - cpu, time.perf_counter() - wall
    return {
        "signal_s": seconds, "stream_cpu_s": spent_cpu, "stream_wall_s": spent_wall,
        "times_real_time_cpu": seconds / spent_cpu, "times_real_time_wall": seconds / spent_wall,
        "resident_early_gb": memory_gb[min(WARM_MINUTES, len(memory_gb)) - 1], "resident_late_gb": memory_gb[-1],
        "resident_most_gb": max(memory_gb),
    }  # fmt: skip


def _resident_gb() -> float:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e9


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=RESULTS)
    parser.add_argument("--minutes", type=float, default=MINUTES, help="length of the long stream")
    parser.add_argument("--part", choices=("first", "long"), help="measure one part and print it as JSON")
    arguments = parser.parse_args()
    if arguments.part:
        print(json.dumps(first_frames() if arguments.part == "first" else long_stream(arguments.minutes)))
        return 0
    values: dict[str, float] = {}
    for part in ("first", "long"):
        command = [sys.executable, __file__, "--part", part, "--minutes", str(arguments.minutes)]
        values |= json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    config = {"sentences": list(SENTENCES), "minutes": arguments.minutes, "threads": 1}
    report(arguments.out, "stream", {"name": "bundled sample room, network"}, values, config)
    return 0


if __name__ == "__main__":
    sys.exit(main())
