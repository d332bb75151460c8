"""Training of a pose network from a task file: people perform its sentences in front of its radar; joints are known.

Poses from point clouds, by weights of `mmweaver train pose`.

estimator = load_estimator("model/")
pose = estimator.estimate(cloud, num_frames)  # a PoseSequence, one pose per frame
"""

import hashlib
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.point_frames import PointFrames, point_frames
from mmweaver.models.weights import WEIGHTS_FILE, WeightsCard, save_weights
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.subject_simulation import PerformancePrior
from mmweaver.recognition.task_file import RecognitionTask, RecordedColumns, RecordingSettings, read_task
from mmweaver.training.pose_training import PosedFrames, PoseLearner, PoseRecipe, PoseWindows, train_pose
from mmweaver.training.trained_weights import weights_card
from mmweaver.training.trainer import Listener, Trainer

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


SEQUENCES, SEQUENCE_FOLDER = 40, "sequences"
HELD_OUT = 8  # one person in so many
# Amplitudes are those of the motion library, since joints are learned here; for recognisers they are smaller.
# Feet: people stand and squat with their heels 0.2 to 0.5 m apart; in the library they are always close.
POSE_PRIOR = PerformancePrior(
    usual_amplitude=1.0,
    amplitude_of_person=0.1,
    amplitude_of_performance=0.05,
    wider_m=(0.0, 0.3),
    heading_of_performance_deg=15.0,
    linger=(0.0, 3.0),
    at_turns=(0.0, 0.0),
)


@dataclass(frozen=True, kw_only=True)
class PoseTraining:
    """Training of a pose network; the same for every task."""

    sequences: int = SEQUENCES  # people who do each activity
    networks: int = 2  # trained one after the other on the same people; their poses are averaged
    recipe: PoseRecipe = PoseRecipe()  # noqa: RUF009 (frozen)

    def __post_init__(self) -> None:
        if not 2 <= self.sequences <= 100_000:
            raise InputError(f"sequences must be 2 to 100000 of each activity, not {self.sequences}")


def posed_frames(recording: PointRecording) -> PosedFrames:
    """A recording with joints as network input; joints of unmeasured frames are interpolated."""
    assert recording.joints_m is not None, "a recording with joints"
    joints_m = recording.joints_m.copy()
    measured = np.flatnonzero(np.isfinite(joints_m).all(axis=(1, 2)))
    for column in joints_m.reshape(len(joints_m), -1).T:
        column[:] = np.interp(np.arange(len(column)), measured, column[measured])
    return PosedFrames(frames=point_frames(recording.cloud, recording.num_frames), joints_m=joints_m)


def _recipe(task: RecognitionTask, seed: int) -> SequenceRecipe:
    """The recipe with boards at typical heights; the effect of high mounts on poses has not been measured."""
    own = SequenceRecipe.of(task, POSE_PRIOR, seed)
    return replace(own, variation=replace(own.variation, high_share=0.0))


def generated_frames(
    task: RecognitionTask,
    sequences: int,
    seed: int,
    folder: Path | None,
    listener: Callable[[int, int], object] | None = None,
) -> list[PointRecording]:
    """Sequences of a task with joints, person by person.

    Args:
        task: The task.
        sequences: Number of people.
        seed: Seed of everything that is sampled.
        folder: Folder for the sequences, None to keep them in memory.
        listener: Called with the number of finished sequences and the total.

    Raises:
        InputError: If no activity has a person in it.
    """
    everything = generate_sequences(_recipe(task, seed), sequences, folder, listener)
    posed = [one for one in everything if one.joints_m is not None]
    if not posed:
        raise InputError("the task has nobody in it: a pose network needs an activity that people do")
    return posed


def split_people(recordings: Sequence[PointRecording], window_frames: int) -> tuple[PoseWindows, PoseWindows]:
    """Windows of generated people to train on, and of those held out, undisturbed."""
    person = [int(one.name.rpartition("_")[2]) for one in recordings]
    held = [number % HELD_OUT == HELD_OUT - 1 for number in person]
    if not any(held):
        held = [number == max(person) for number in person]
    trained, unseen = (
        PoseWindows(
            recordings=[posed_frames(one) for one, is_held in zip(recordings, held, strict=True) if is_held == wanted],
            window_frames=window_frames,
        )
        for wanted in (False, True)
    )
    return trained, replace(unseen, disturbance=None)


def train_pose_of_task(
    task_file: Path | str,
    out: Path | str,
    training: PoseTraining | None = None,
    *,
    tell: Callable[[int, int], object] | None = None,
    listener: Listener | None = None,
    **options: Any,
) -> tuple[list[Path], list[Trainer[PoseLearner]]]:
    """Trains pose networks on people who perform the sentences of a task.

    Sequences are stored in `out`/sequences, so a run can be resumed.

    Args:
        task_file: The task as TOML.
        out: Folder for weights.safetensors, weights_2.safetensors and so on.
        training: How networks are trained; by default `PoseTraining()`.
        tell: Called with the number of finished sequences and the total.
        listener: Called after each training step.
        **options: Further arguments of `train_pose`.

    Returns:
        Weight files and trainers, one per network.

    Raises:
        InputError: For a task or a folder that cannot be used.
    """
    training, out, task = training or PoseTraining(), Path(out), read_task(task_file)
    recipe = training.recipe
    made = generated_frames(task, training.sequences, recipe.seed, out / SEQUENCE_FOLDER, tell)
    trained, unseen = split_people(made, task.recordings.window_frames)
    files, trainers = [], []
    for number in range(1, training.networks + 1):
        first, own = number == 1, replace(recipe, seed=recipe.seed + number - 1)
        trainer = train_pose(
            trained, unseen, out if first else out / f"network_{number}", own, listener=listener, **options
        )
        name = WEIGHTS_FILE if first else WEIGHTS_FILE.replace(".", f"_{number}.")
        files.append(write_pose_weights(out / name, task, trainer, recipe.seed))
        trainers.append(trainer)
    return files, trainers


def write_pose_weights(file: Path, task: RecognitionTask, trainer: Trainer[PoseLearner], people_seed: int) -> Path:
    """Writes the best network, with the settings that are needed to apply it.

    Args:
        file: The weight file.
        task: The task, for its recordings and radar.
        trainer: The finished training.
        people_seed: Seed of the generated people.

    Returns:
        The file.
    """
    columns = task.recordings.columns
    settings = {
        "window_s": float(task.recordings.window_s),
        "frame_rate_hz": float(task.recordings.frame_rate_hz),
        "columns": None if columns is None else list(columns.names),
        "activities": {label: list(sentences) for label, sentences in task.activities.items()},
    }
    people = hashlib.sha256(_recipe(task, people_seed).as_json().encode()).hexdigest()
    card = weights_card(trainer, dataset_sha256=people, radar=task.radar.name, settings=settings)
    save_weights(file, trainer.learner.network, card)
    return file
