"""Photo and sentence -> cube: the network and physics, in one run, in the same room with the same motion.

Both are warm: the room is prepared or encoded once and kept, as it is in use. Needs weights of `mmweaver train`.
Writes results/benchmark/weaver.json in the project's results schema and prints the same as a table.
"""

import argparse
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import torch
from measuring import RESULTS, report

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, RadarCube
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS, FIRST_ORDER
from mmweaver.signal.cube import radar_cube
from mmweaver.weaver.front_door import Weaver

SENTENCE = "a person walks towards the radar, then waves with the left hand"
NUM_FRAMES, ROUNDS = 20, 15


def least(functions: dict[str, Callable[[], object]]) -> dict[str, float]:
    """The least CPU and wall seconds of each, taken in turns so that a busy machine treats them alike."""
    best: dict[str, float] = {}
    for turn in range(ROUNDS + 1):
        for name, function in functions.items():
            cpu, wall = time.process_time(), time.perf_counter()
            function()
            spent = {"cpu_s": time.process_time() - cpu, "wall_s": time.perf_counter() - wall}
            if turn:  # the first warms up
                for unit, seconds in spent.items():
                    best[f"{name}_{unit}"] = min(best.get(f"{name}_{unit}", seconds), seconds)
    return best


def costs(weights: Path, *, with_physics: bool) -> dict[str, float]:
    """Seconds of all steps."""
    weaver = Weaver(method="physics", radar="awr1843")
    scene, config = weaver.sample_room().scene, weaver.radar
    window = (float(config.range_m[0]), float(config.range_m[-1]))

    def posed() -> PoseSequence:
        return compose(plan_motion(SENTENCE, 2.0), scene, seed=0, range_window_m=window).pose

    pose = posed()
    network, _ = load_weights(weights)
    room = LearnedRoom(network, scene, config)
    steps: dict[str, Callable[[], object]] = {
        "sentence_to_motion": posed,
        "weaver_motion_to_cube": lambda: room.cube([FrameMotion.of(pose, config, NUM_FRAMES)], seed=0),
        "weaver_encode_room": lambda: LearnedRoom(network, scene, config),
    }
    if with_physics:
        for name, propagation in (("physics", ALL_PATHS), ("first_order", FIRST_ORDER)):
            simulator = Simulator(scene, config, propagation=propagation)
            steps[f"{name}_motion_to_cube"] = partial(_simulated, simulator, pose)
    return least(steps)


def _simulated(simulator: Simulator, pose: PoseSequence) -> RadarCube:
    return radar_cube(simulator.run(pose, num_frames=NUM_FRAMES, seed=0).adc)


def peak_memory_gb(weights: Path) -> float:
    """Of a process of its own that does nothing but this."""
    command = [sys.executable, __file__, "--weights", str(weights), "--memory"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(done.stdout)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=RESULTS)
    parser.add_argument("--weights", type=Path, help="default: those that come with mmweaver")
    parser.add_argument("--memory", action="store_true", help="print the network's peak memory in GB, and no more")
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    try:
        weights = arguments.weights or shipped_weights()
    except InputError as error:
        print(f"the network is not measured: {error}")
        return 0
    if arguments.memory:
        costs(weights, with_physics=False)
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6)
        return 0
    values = costs(weights, with_physics=True)
    physics, woven = values["physics_motion_to_cube_cpu_s"], values["weaver_motion_to_cube_cpu_s"]
    values["times_fewer_cpu_s_than_physics"] = physics / woven
    values["sentence_to_cube_wall_s"] = values["sentence_to_motion_wall_s"] + values["weaver_motion_to_cube_wall_s"]
    values["weaver_peak_memory_gb"] = peak_memory_gb(weights)
    dataset = {"name": f"bundled sample room, {NUM_FRAMES} frames", "text": SENTENCE}
    report(arguments.out, "weaver", dataset, values, {"threads": 1, "rounds": ROUNDS})
    return 0


if __name__ == "__main__":
    sys.exit(main())
