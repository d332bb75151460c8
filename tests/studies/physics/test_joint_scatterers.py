"""Points at the joints: where they are, and how strong."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import IWR1443_MARS
from mmweaver.core.records import PoseSequence
from mmweaver.motion.micro_motion import STILL
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import Impairments
from mmweaver.signal.cube import radar_cube
from studies.physics.empty_room_cube import empty_room
from studies.physics.joint_scatterers import run_joints
from studies.physics.mars_data import joints_from_kinect
from tests.studies.physics.test_mars_data import standing_kinect


def test_the_body_is_where_its_joints_are():
    joints = joints_from_kinect(standing_kinect()[None])
    pose = PoseSequence(time_s=np.array([0.0, 0.1, 0.2]), joints_m=np.repeat(joints, 3, axis=0), height_m=1.75)
    config = replace(IWR1443_MARS, first_range_bin=0)
    silent = Impairments(thermal_noise=False, phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0, quantise=False)
    simulator = Simulator(empty_room(floor_z_m=-1.0, has_floor=False), config, silent)
    room = simulator.run((), num_frames=2, seed=0).adc.samples
    made = run_joints(simulator, pose, num_frames=2, seed=0, motions=STILL)
    brighter = run_joints(simulator, pose, num_frames=2, seed=0, motions=STILL, brighter=4.0)
    alone, louder = made.samples - room, brighter.samples - room
    assert np.abs(louder - 2 * alone).max() < 1e-3 * np.abs(alone).max()
    power = (np.abs(radar_cube(replace(made, samples=alone)).values) ** 2).sum(axis=(0, 2, 3))
    distance_m = config.range_resolution_m * (config.first_range_bin + int(np.argmax(power)))
    nearest, farthest = np.quantile(np.linalg.norm(joints[0], axis=1), [0.0, 1.0])
    assert nearest - 0.1 < distance_m < farthest + 0.1
    assert distance_m == pytest.approx(1.95, abs=0.25)
