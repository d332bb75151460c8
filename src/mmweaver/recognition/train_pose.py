"""Training of a pose network from a task file: people perform its sentences in front of its radar; joints are known."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.models.point_frames import point_frames
from mmweaver.models.weights import WEIGHTS_FILE, save_weights
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.subject_simulation import PerformancePrior
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.training.pose_training import PosedFrames, PoseLearner, PoseRecipe, PoseWindows, train_pose
from mmweaver.training.trained_weights import weights_card
from mmweaver.training.trainer import Listener, Trainer

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
