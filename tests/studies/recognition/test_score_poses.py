"""Pose scores on MARS: the mean pose of the same person is exact where that person stands still."""

from pathlib import Path

import torch

from mmweaver.models.pose_network import PoseNetwork
from mmweaver.recognition.task_file import RecordingSettings
from mmweaver.recognition.train_pose import PoseEstimator
from studies.recognition.score_poses import score_poses
from tests.studies.physics.test_mars_data import write_split


def test_networks_are_scored_next_to_mean_poses(tmp_path: Path):
    write_split(tmp_path, "validate", list(range(20)))
    write_split(tmp_path, "test", list(range(20)), moving=0.1)
    torch.manual_seed(0)
    settings = RecordingSettings(labels=(), window_s=0.8, frame_rate_hz=10.0)
    scores = score_poses(PoseEstimator(networks=[PoseNetwork().eval()], settings=settings), tmp_path, "test")
    assert set(scores["mean"]) == {"network", "generated_mean_pose", "real_mean_pose", "network_calibrated"}
    assert scores["mean"]["real_mean_pose"]["root"]["all"] < 1e-3 < scores["mean"]["network"]["root"]["all"]
