"""A recogniser trained within a second on clouds that are drawn, not simulated: label 0 stays, the others move."""

from pathlib import Path

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.recogniser import Recogniser
from mmweaver.recognition.task_file import RecordingSettings, read_task
from mmweaver.recognition.train_recogniser import fitted
from mmweaver.recognition.training_windows import TrainingOptions, generated_windows
from tests.recognition.clouds import recording_of

OPTIONS = TrainingOptions(sequences=6, copies=1, trees=15)
SECONDS = 8.0


def drawn_recording(settings: RecordingSettings, label: str, person: int, seconds: float = SECONDS) -> PointRecording:
    """A person at rest, or one who goes to and fro, the faster the later the label."""
    rng = np.random.default_rng([person, settings.labels.index(label)])
    frames = max(int(seconds * settings.frame_rate_hz), 1)
    frame = np.repeat(np.arange(frames), 6)
    speed = 0.7 * settings.labels.index(label)
    phase = 2 * np.pi * (frame / settings.frame_rate_hz / 2 + rng.random())
    x, z, y = (rng.normal(0, spread, len(frame)) for spread in (0.2, 0.3, 0.05))
    velocity = speed * np.cos(phase) + rng.normal(0, 0.15, len(frame))
    return recording_of(
        frame, x_m=x, y_m=2 + 0.3 * speed * np.sin(phase) + y, z_m=z, velocity_mps=np.round(velocity / 0.356) * 0.356,
        num_frames=frames, rate_hz=settings.frame_rate_hz, name=f"{label}_{person}", label=label,
    )  # fmt: skip


def drawn_sequences(settings: RecordingSettings, people: int = 6, first: int = 0) -> list[PointRecording]:
    """One recording of each person and label."""
    return [
        drawn_recording(settings, label, person) for person in range(first, first + people) for label in settings.labels
    ]


def small_recogniser(task_file: Path) -> Recogniser:
    """Trained on `drawn_sequences`, once for each text of a task."""
    text = task_file.read_text()
    if text not in _trained:
        _trained[text] = _fitted(task_file)
    return _trained[text]


_trained: dict[str, Recogniser] = {}


def _fitted(task_file: Path) -> Recogniser:
    task = read_task(task_file)
    made = generated_windows(drawn_sequences(task.recordings), task, OPTIONS)
    return fitted(made, [], task, OPTIONS)


def write_recordings(folder: Path, recordings: list[PointRecording]) -> None:
    """As .npz in folders named by label, columns x right, y ahead, z up, velocity."""
    for one in recordings:
        (folder / one.label).mkdir(parents=True, exist_ok=True)
        cloud = one.cloud
        pts = np.stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps], axis=1).astype(np.float32)
        np.savez(folder / one.label / f"{one.name}.npz", frame=cloud.frame, pts=pts)
