"""`make bench`: what the physics costs, as ratios measured in one run, CPU-seconds and peak memory.

Writes results/benchmark/physics.json in the project's results schema and prints the same as a table.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measuring import report, results_folder

ROOT = Path(__file__).resolve().parents[1]
SENTENCE = "a person walks towards the radar, then waves with the left hand"


def cpu_seconds(function, repeats: int = 3) -> float:
    """The least of some runs; CPU time, so that a busy machine counts less."""
    best = np.inf
    for _ in range(repeats):
        start = time.process_time()
        function()
        best = min(best, time.process_time() - start)
    return float(best)


def simulation_costs() -> dict[str, float]:
    from mmweaver import Weaver
    from mmweaver.motion.compose import compose
    from mmweaver.motion.language.timing import plan_motion
    from mmweaver.propagation.body_model import body_of
    from mmweaver.propagation.body_paths import BodyPaths
    from mmweaver.propagation.paths import Interaction
    from mmweaver.propagation.ray_traced import Simulator
    from mmweaver.propagation.reference_sum import exact_frame
    from mmweaver.signal.cube import radar_cube

    weaver = Weaver(method="physics", radar="awr1843")
    scene = weaver.sample_room().scene
    config = weaver.radar
    window = (float(config.range_m[0]), float(config.range_m[-1]))
    pose = compose(plan_motion(SENTENCE, 2.0), scene, seed=0, range_window_m=window).pose
    room_s = cpu_seconds(lambda: Simulator(scene, config), 1)
    simulator = Simulator(scene, config)
    run_s = cpu_seconds(lambda: simulator.run(pose, num_frames=20, seed=0, num_points=800))
    adc = simulator.run(pose, num_frames=20, seed=0).adc
    frame = np.arange(1)
    body = BodyPaths(simulator.room, body_of(pose), simulator.clock, simulator._joints_at_nodes(pose, frame))
    (paths,) = body.paths(0)
    direct = paths.departure.position_m[paths.interaction == int(Interaction.BODY)][:100].numpy()
    one_frame_s = cpu_seconds(
        lambda: exact_frame(
            lambda t: np.repeat(direct[:, None], len(t), axis=1), np.ones(len(direct), complex), config
        ),
        1,
    )
    exact_s = one_frame_s / len(direct) * len(paths) * 20
    a = np.ones((256, len(paths)), np.complex64)
    b = np.ones((len(paths), 384), np.complex64)
    gemm_s = cpu_seconds(lambda: [a @ b for _ in range(20)])
    return {
        "room_cpu_s": room_s,
        "sequence_cpu_s": run_s,
        "cube_cpu_s": cpu_seconds(lambda: radar_cube(adc)),
        "paths_in_frame_0": float(len(paths)),
        "exact_sum_cpu_s_extrapolated": exact_s,
        "times_cheaper_than_exact": exact_s / run_s,
        "times_its_matrix_product": run_s / gemm_s,
    }


def whole_command(name: str, *arguments: str) -> dict[str, float]:
    """`mmweaver` with these arguments in a process of its own: wall, CPU, peak memory."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "mmweaver", *arguments]
        start = time.perf_counter()
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
    if status:
        raise SystemExit(f"{' '.join(arguments)}: failed")
    return {
        f"{name}_wall_s": wall,
        f"{name}_cpu_s": usage.ru_utime + usage.ru_stime,
        f"{name}_peak_memory_gb": usage.ru_maxrss / 1e6,
    }


def synthesis_errors() -> dict[str, float]:
    """Error of the range-Doppler cube against the exact sum, dB, of 40 points that move as the names say."""
    sys.path.insert(0, str(ROOT))
    from tests.physics.test_reference_sum import error_db

    cases = {"at_rest": (0.0, 0.0), "at_0.5_mps": (0.5, 5.0), "at_3_mps": (3.0, 30.0)}
    return {f"synthesis_error_{name}_db": float(error_db(*case)) for name, case in cases.items()}


def main() -> int:
    out = results_folder(__doc__)
    demo = ("generate", "--demo", "--text", SENTENCE, "--out", "out")
    commands = {
        **whole_command("help", "--help"),
        **whole_command("command", *demo),
        **whole_command("physics_command", *demo, "--method", "physics"),
    }
    values = {**commands, **simulation_costs(), **synthesis_errors()}
    dataset = {"name": "bundled sample room, 20 frames", "text": SENTENCE, "body_points": 800}
    report(out, "physics", dataset, values, {"blas_threads": 1})
    return 0


if __name__ == "__main__":
    sys.exit(main())
