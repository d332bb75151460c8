"""The pose network learns a moving arm, better than the mean pose, and its weights are read back."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.evaluation.pose_errors import joint_errors_cm
from mmweaver.recognition.task_file import RecordingSettings
from mmweaver.recognition.train_pose import PoseEstimator, posed_frames
from mmweaver.training.pose_training import Disturbance, PoseRecipe, PoseWindows, mean_pose_m, train_pose
from tests.training.moving_arm import moving_arm

RECIPE = PoseRecipe(
    steps=300, batch_size=8, warm_up_steps=5, learning_rate=1e-3, validate_every=100, validation_batches=1
)


@pytest.mark.slow  # tests/cli/test_pose.py trains two steps
def test_it_learns_what_moves(tmp_path: Path):
    # what the estimator averages over: mirrors and time backwards
    turned = Disturbance(
        mirrored=0.5, backwards=0.5, shift_m=(0.0, 0.0, 0.0), tilt_deg=0.0, point_m=0.0, strength_db=0.0, thinned=0.0,
        with_gaps=0.0,
    )  # fmt: skip
    arms = [posed_frames(moving_arm(k)) for k in range(6)]
    trained = PoseWindows(recordings=arms, window_frames=6, disturbance=turned)
    other = posed_frames(moving_arm(9))
    unseen = PoseWindows(recordings=[other], window_frames=6, disturbance=None)
    trainer = train_pose(trained, unseen, tmp_path, RECIPE)
    settings = RecordingSettings(labels=(), window_s=0.6, frame_rate_hz=10.0)
    estimator = PoseEstimator(networks=[trainer.learner.network], settings=settings)
    found = joint_errors_cm(estimator.joints_m(other.frames), other.joints_m, "root")
    mean = np.repeat(mean_pose_m(trained)[None], len(other), axis=0)
    assert found["arms"] < 0.6 * joint_errors_cm(mean, other.joints_m, "root")["arms"]


def test_windows_longer_than_all_recordings_are_refused(tmp_path: Path):
    windows = PoseWindows(recordings=[posed_frames(moving_arm(0))], window_frames=50)
    with pytest.raises(InputError, match="50 frames"):
        train_pose(windows, windows, tmp_path, RECIPE)
