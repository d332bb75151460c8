"""The simplest body model: equal point scatterers at the joints, without skin or occlusion. A baseline for the body."""

import numpy as np
import torch

from mmweaver.core.records import AdcCube, PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.motion.physiology import Physiology, PhysiologySettings
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.paths import ApparentPoint, Paths, ScenePaths
from mmweaver.propagation.ray_traced import Simulator, add_physiology
from mmweaver.propagation.receiver import Receiver
from mmweaver.propagation.visible_body import motion_through

TOTAL_M2 = 10**-0.5  # cross section of all joints together: -5 dBsm, as the skin has over all aspects


def run_joints(
    simulator: Simulator,
    pose: PoseSequence,
    *,
    num_frames: int,
    seed: int,
    motions: PhysiologySettings,
    brighter: float = 1.0,
) -> AdcCube:
    """ADC samples of the room and a person of 22 isotropic points; `brighter` multiplies their cross section.

    Raises InputError as `Simulator.chunks` does.
    """
    frames = np.arange(num_frames)
    nodes_m, _ = simulator.trace(pose, num_frames=num_frames, seed=seed)
    unrest = Physiology(pose.subject, seed, motions)
    joints_m, _ = add_physiology(unrest, nodes_m.astype(float), frames, simulator.clock, pose.height_m)
    phase = np.exp(2j * np.pi * stream(pose.subject, "joint scatterers").random(NUM_JOINTS))
    receiver = Receiver(simulator.config, simulator.impairments, seed)
    middle = joints_m[:, joints_m.shape[1] // 2]  # (frame, joint, 3)
    distance_m = np.linalg.norm(middle, axis=-1)
    directions = (middle / distance_m[..., None]).reshape(-1, 3)
    gain = scatterer_gain(simulator.config) * pattern(directions, simulator.config).reshape(distance_m.shape) ** 2
    amplitude = gain * np.sqrt(brighter * TOTAL_M2 / NUM_JOINTS) / distance_m**2 * phase
    motion = motion_through(joints_m, simulator.clock)  # (frame, segment, joint, 3, 3)
    each = np.repeat(amplitude[:, None], motion.shape[1], axis=1).reshape(-1, NUM_JOINTS)
    joints = ApparentPoint.of(motion.reshape(-1, NUM_JOINTS, 3, 3))
    static = simulator.room.paths
    paths = ScenePaths(
        static=static, moving=Paths.direct(torch.from_numpy(each), joints),
        occluded=torch.zeros(num_frames, len(static), dtype=torch.float32),
    )  # fmt: skip
    return AdcCube(samples=simulator.samples(paths, frames, receiver).numpy(), config=simulator.config, scale=1.0)
