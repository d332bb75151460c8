"""Poses from point clouds, by weights of `mmweaver train pose`.

estimator = load_estimator("model/")
pose = estimator.estimate(cloud, num_frames)  # a PoseSequence, one pose per frame
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.point_frames import PointFrames, point_frames
from mmweaver.models.weights import WeightsCard
from mmweaver.recognition.task_file import RecordedColumns, RecordingSettings

if TYPE_CHECKING:
    from mmweaver.models.pose_network import PoseNetwork

STEPS_PER_WINDOW = 8  # windows overlap by seven eighths, and their poses are averaged
EVENED_S = 0.1  # standard deviation of the Gaussian that smooths joints over time
AT_ONCE = 64
CROWN_OVER_HEAD_M = 0.11
ALL_WEIGHTS = "weights*.safetensors"


@dataclass(frozen=True, kw_only=True)
class PoseEstimator:
    """One or several networks, whose poses are averaged, and how recordings are read for them."""

    networks: Sequence["PoseNetwork"]
    settings: RecordingSettings

    def estimate(self, cloud: PointCloud, num_frames: int) -> PoseSequence:
        """Poses of all frames of a point cloud.

        Args:
            cloud: Points, recorded or generated.
            num_frames: Number of frames, from 0.

        Returns:
            One person's joints in the radar's level axes, one pose per frame.

        Raises:
            InputError: For fewer frames than a window, or a cloud without points.
        """
        if not len(cloud.frame):
            raise InputError("no frame has a point, so there is nobody to give poses of")
        joints_m = self.joints_m(point_frames(cloud, num_frames))
        height_m = float(np.median(np.ptp(joints_m[..., 2], axis=1))) + CROWN_OVER_HEAD_M
        return PoseSequence(
            time_s=np.arange(num_frames) / self.settings.frame_rate_hz, joints_m=joints_m, height_m=height_m
        )

    @property
    def mean_pose_m(self) -> Float[np.ndarray, "22 3"]:
        """Mean pose (22, 3) of the training data relative to the pelvis, in metres."""
        return np.mean([network.mean_m.numpy() for network in self.networks], axis=0)

    def joints_m(self, frames: PointFrames) -> Float[np.ndarray, "frame 22 3"]:
        """Joints of every frame, averaged over overlapping windows with a Hann weight and smoothed over time.

        Args:
            frames: Points of all frames.

        Returns:
            Joints (frame, 22, 3) in metres.

        Raises:
            InputError: For fewer frames than a window.
        """
        from scipy.ndimage import gaussian_filter1d

        length, num_frames = self.settings.window_frames, len(frames.values)
        if num_frames < length:
            raise InputError(f"{num_frames} frames are fewer than a window of {length}; give a longer recording")
        first = np.unique([*range(0, num_frames - length, max(length // STEPS_PER_WINDOW, 1)), num_frames - length])
        weight = np.hanning(length + 2)[1:-1]
        total, weights = np.zeros((num_frames, NUM_JOINTS, 3)), np.zeros(num_frames)
        for begin in range(0, len(first), AT_ONCE):
            starts = first[begin : begin + AT_ONCE]
            for start, joints in zip(
                starts, self._windows([frames.part(int(one), length) for one in starts]), strict=True
            ):
                total[start : start + length] += weight[:, None, None] * joints
                weights[start : start + length] += weight
        return gaussian_filter1d(total / weights[:, None, None], EVENED_S * self.settings.frame_rate_hz, axis=0)

    def _windows(self, windows: Sequence[PointFrames]) -> Float[np.ndarray, "window frame 22 3"]:
        import torch

        from mmweaver.training.pose_training import MIRRORED, batch_of

        nothing = np.zeros((self.settings.window_frames, NUM_JOINTS, 3))
        found = []
        # test-time augmentation: mirrored windows give mirrored poses, reversed ones the same; the mean is better
        for side, time in itertools.product((-1, 1), (-1, 1)):
            seen = [
                PointFrames(
                    values=one.values[::time] * np.array([side, 1, 1, time, 1], np.float32),
                    is_there=one.is_there[::time],
                )
                for one in windows
            ]
            batch = batch_of([(window, nothing) for window in seen])
            with torch.inference_mode():
                poses = [network(batch.values, batch.is_there, batch.middle_m) for network in self.networks]
            joints_m = np.mean([(joints + pelvis[:, :, None]).numpy() for joints, pelvis in poses], axis=0)
            joints_m = joints_m[:, ::time] * np.array([side, 1.0, 1.0])
            found.append(joints_m[:, :, MIRRORED] if side < 0 else joints_m)
        return np.mean(found, axis=0)


def load_estimator(place: Path | str) -> PoseEstimator:
    """Loads a weight file of recipe `pose`, or all networks in a folder of `mmweaver train pose`.

    Args:
        place: File or folder.

    Raises:
        InputError: If there are no weights, or they are for different recordings.
    """
    from mmweaver.models.pose_network import load_pose

    place = Path(place)
    files = sorted(place.glob(ALL_WEIGHTS)) if place.is_dir() else [place]
    if not files or not files[0].is_file():
        raise InputError(f"{place} holds no weights; mmweaver train pose TASK.toml --out {place} makes them")
    loaded = [(file, *load_pose(file)) for file in files]
    settings = [_settings(card, file) for file, _, card in loaded]
    if any(one != settings[0] for one in settings):
        raise InputError(f"{place} holds networks for different recordings; give one of its files")
    return PoseEstimator(networks=[network for _, network, _ in loaded], settings=settings[0])


def _settings(card: WeightsCard, file: Path) -> RecordingSettings:
    """How recordings are read, from the header of the weights."""
    window_s, rate_hz, columns = (card.settings.get(name) for name in ("window_s", "frame_rate_hz", "columns"))
    if isinstance(window_s, float) and isinstance(rate_hz, float) and 0 < window_s < 1000 and 0 < rate_hz < 1000:
        named = None if columns is None else RecordedColumns.of(columns, str(file))
        return RecordingSettings(labels=(), window_s=window_s, frame_rate_hz=rate_hz, columns=named)
    raise InputError(f"{file} does not say for which recordings it was trained; train it again")
