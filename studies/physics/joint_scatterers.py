"""The plainest body there is, equal points at the joints without skin or shadow: what a body model is worth."""

import numpy as np

from mmweaver.core.records import AdcCube, PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.motion.micro_motion import MicroMotion, MicroMotionSettings
from mmweaver.paths.adc_synthesis import EchoRows, synthesise
from mmweaver.paths.antenna import pattern, scatterer_gain
from mmweaver.paths.ray_traced import Simulator, with_micro_motion
from mmweaver.paths.receiver import Receiver

TOTAL_M2 = 10**-0.5  # cross section of all joints together: -5 dBsm, as the skin has over all aspects


def run_joints(
    simulator: Simulator,
    pose: PoseSequence,
    *,
    num_frames: int,
    seed: int,
    motions: MicroMotionSettings,
    brighter: float = 1.0,
) -> AdcCube:
    """ADC samples of the room and a person of 22 isotropic points; `brighter` multiplies their cross section.

    Raises InputError as `Simulator.chunks` does.
    """
    frames = np.arange(num_frames)
    nodes_m, _ = simulator.look(pose, num_frames=num_frames, seed=seed)
    unrest = MicroMotion(pose.subject, seed, motions)
    joints_m, _ = with_micro_motion(unrest, nodes_m.astype(float), frames, simulator.clock, pose.height_m)
    phase = np.exp(2j * np.pi * stream(pose.subject, "joint scatterers").random(NUM_JOINTS))
    receiver = Receiver(simulator.config, simulator.impairments, seed)
    samples = []
    for frame in frames:
        place = joints_m[frame]  # (node, joint, 3)
        middle = place[len(place) // 2]
        distance_m = np.linalg.norm(middle, axis=1)
        gain = scatterer_gain(simulator.config) * pattern(middle / distance_m[:, None], simulator.config) ** 2
        amplitude = gain * np.sqrt(brighter * TOTAL_M2 / NUM_JOINTS) / distance_m**2 * phase
        ways = place.transpose(1, 0, 2)
        rows = EchoRows(out_m=ways, back_m=ways, amplitude=amplitude, is_mixed=np.zeros(NUM_JOINTS, bool))
        person = synthesise(rows, simulator.clock)
        samples.append(receiver.receive(person, simulator.room_adc, simulator.room.adc_rate, int(frame)))
    return AdcCube(samples=np.stack(samples), config=simulator.config, scale=1.0)
