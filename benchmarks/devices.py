"""What a sequence costs on the CPU and on a GPU if there is one: made from a prepared room, and by the network.

Rooms, motions and weights are synthetic, as large as real ones, so that it runs where nothing but numpy, scipy,
torch and transformers is installed: no ray caster. Writes results/benchmark/devices_<device>.json and prints the same
as a table.
"""

import os
import sys
import time
from collections.abc import Callable

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import torch
from measuring import report, results_folder

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import Plane
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.body_model import DEFAULT_NUM_POINTS
from mmweaver.propagation.body_paths import GHOST_POINTS
from mmweaver.propagation.image_method import SpecularReflector
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.paths import ApparentPoint, FrameClock, Interaction, Paths
from mmweaver.propagation.receiver import IDEAL, Receiver
from mmweaver.propagation.resynthesis import Resynthesis, TracedMotion
from mmweaver.propagation.static_paths import FIRST_ORDER, PreparedRoom, scattered_paths
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.signal.cube import cube_values

NUM_FRAMES, STATIC_PATHS, FACES, OCCLUDED, MOVING_PATHS = 20, 8300, 5, 400, 900


def synthetic_room(rng: np.random.Generator) -> PreparedRoom:
    place = rng.uniform((-2, 0.7, -1), (2, 4.0, 1.2), (STATIC_PATHS, 3))
    amplitude = 1e-3 * (rng.normal(size=STATIC_PATHS) + 1j * rng.normal(size=STATIC_PATHS))
    reflectors = []
    for turn in np.linspace(-1.2, 1.2, FACES):
        normal = -np.array([np.sin(turn), np.cos(turn), 0.0])
        along = np.array([-normal[1], normal[0], 0.0])
        up = np.array([0.0, 0.0, 1.0])
        plane = Plane(
            kind="wall", centre_m=-3.5 * normal, normal=normal, axis_u=along, axis_v=up, half_size_m=(2.5, 1.3),
            material="plasterboard",
        )  # fmt: skip
        reflectors.append(SpecularReflector(plane=plane, offset_m=-3.5))
    return PreparedRoom(
        AWR1843, reflectors, scattered_paths(place, amplitude, Interaction.DIFFUSE, AWR1843), FIRST_ORDER
    )


def synthetic_motion(rng: np.random.Generator, clock: FrameClock) -> TracedMotion:
    time_s = np.arange(NUM_FRAMES)[:, None] * AWR1843.frame_period_s + clock.node_s
    joints = rng.normal((0.0, 2.3, -0.2), (0.2, 0.1, 0.4), (NUM_JOINTS, 3))
    joints_m = joints + np.array([0.1, -0.4, 0.0]) * time_s[..., None, None]
    occluded = np.zeros((NUM_FRAMES, STATIC_PATHS), bool)
    occluded[:, :OCCLUDED] = True
    visibility = Visibility(
        skin=rng.random((NUM_FRAMES, DEFAULT_NUM_POINTS)) < 0.4,
        over_faces=rng.random((NUM_FRAMES, FACES, GHOST_POINTS)) < 0.5,
        occluded=occluded,
    )
    return TracedMotion(joints_m=joints_m.astype(np.float32), visibility=visibility, subject=0, height_m=1.75, seed=0)


def error(device: str) -> float:
    """Relative error of the device's samples of moving paths against those of the CPU."""
    paths = synthetic_paths(np.random.default_rng(1), 1)
    wanted = AdcSynthesis(AWR1843).moving(paths)
    got = AdcSynthesis(AWR1843, device).moving(paths).cpu()
    return float((got - wanted).norm() / wanted.norm())


def synthetic_paths(rng: np.random.Generator, num_frames: int) -> Paths:
    """Direct paths within 4 m, as fast as limbs, (frame, path)."""
    shape = (num_frames, MOVING_PATHS)
    motion = np.zeros((*shape, 3, 3))
    motion[..., 0, :] = rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (*shape, 3))
    motion[..., 1, :] = rng.normal(0, 2, (*shape, 3))
    amplitude = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    return Paths.direct(torch.from_numpy(amplitude), ApparentPoint.of(motion))


def measured(device: str) -> dict[str, float]:
    rng = np.random.default_rng(0)
    room, other = Resynthesis(synthetic_room(rng), device), Resynthesis(synthetic_room(rng), device, IDEAL)
    motion, frames = synthetic_motion(rng, room.synthesis.clock), np.arange(NUM_FRAMES)

    def cube(of: Resynthesis, number: int) -> Callable[[], object]:
        return lambda: cube_values(of.samples(motion, frames, realization=number), AWR1843).cpu()

    values = {"relative_error_of_moving_paths": error(device)}
    for name, function in {
        "sequence": cube(room, 1), "sequence_noise_from_streams": cube(room, 0), "sequence_ideal": cube(other, 0),
    }.items():  # fmt: skip
        cpu, wall = [], []
        for _ in range(12):
            began = time.process_time(), time.perf_counter()
            function()
            cpu.append(time.process_time() - began[0])
            wall.append(time.perf_counter() - began[1])
        values |= {f"{name}_cpu_s": min(cpu), f"{name}_wall_s": min(wall)}
    values["synthesis_of_paths_wall_s"] = synthesis_seconds(room)
    values |= network_seconds(device)
    if device == "cuda":
        values["peak_device_memory_gb"] = torch.cuda.max_memory_allocated() / 1e9
    return values


def network_seconds(device: str) -> dict[str, float]:
    """Motion to cube by the network, the room encoded once; its paths are sampled and rendered on the CPU."""
    torch.manual_seed(0)
    room = LearnedRoom(WeaverNetwork().eval(), make_room("office", 0, 0).scene(), AWR1843, device=device)
    joints = np.random.default_rng(0).normal((0.0, 2.3, -0.2), (0.2, 0.1, 0.4), (NUM_FRAMES, NUM_JOINTS, 3))
    motion = FrameMotion(
        joints_m=joints.astype(np.float32), velocity_mps=np.zeros_like(joints, dtype=np.float32), subject=0
    )
    cpu, wall = [], []
    for seed in range(15):
        began = time.process_time(), time.perf_counter()
        room.cube([motion], seed=seed)
        cpu.append(time.process_time() - began[0])
        wall.append(time.perf_counter() - began[1])
    return {"network_motion_to_cube_cpu_s": min(cpu), "network_motion_to_cube_wall_s": min(wall)}


def synthesis_seconds(room: Resynthesis) -> float:
    """Wall seconds of the device's share of 20 frames: synthesis, receiver, transforms."""
    synthesis = room.synthesis
    paths = synthetic_paths(np.random.default_rng(2), NUM_FRAMES).to(synthesis.device)
    static = torch.zeros(NUM_FRAMES, 3, 4, AWR1843.num_samples, dtype=torch.complex64, device=synthesis.device)
    receiver, frames = Receiver(AWR1843, room.impairments, 0), range(NUM_FRAMES)
    seconds = []
    for _ in range(8):
        began = time.perf_counter()
        samples = receiver.receive(synthesis.moving(paths), static, static[0], frames, on_device=True)
        cube_values(samples, AWR1843).cpu()
        seconds.append(time.perf_counter() - began)
    return min(seconds)


def main() -> int:
    out = results_folder(__doc__)
    torch.set_num_threads(1)
    for device in ("cpu", "cuda") if torch.cuda.is_available() else ("cpu",):
        dataset = {"name": f"synthetic room of {STATIC_PATHS} static paths and {FACES} faces, {NUM_FRAMES} frames"}
        name = torch.cuda.get_device_name() if device == "cuda" else "cpu, one thread"
        report(out, f"devices_{device}", dataset, measured(device), {"device": name, "threads": 1})
    if not torch.cuda.is_available():
        print(without_gpu())
    return 0


def without_gpu() -> str:
    """What to do for the GPU's figures, in one line."""
    built = "this PyTorch is built for the CPU alone" if torch.version.cuda is None else "PyTorch finds none here"
    return (
        f"no GPU figures: {built}; with a GPU and its PyTorch run again: python benchmarks/devices.py"
        " (writes results/benchmark/devices_cuda.json)"
    )


if __name__ == "__main__":
    sys.exit(main())
