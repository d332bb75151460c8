"""Pictures of recorded windows next to generated ones: nobody chooses the window."""

from dataclasses import replace
from pathlib import Path

from mmweaver.recognition.task_file import read_task
from studies.recognition.recognition_pictures import median_windows
from studies.recognition.zero_shot_pictures import draw
from tests.recognition.small_recogniser import drawn_sequences
from tests.recognition.test_train_recogniser import TASK


def test_the_median_window_of_every_label_is_drawn(tmp_path: Path):
    (tmp_path / "task.toml").write_text(TASK.format(more=""))
    windows = drawn_sequences(read_task(tmp_path / "task.toml").recordings, 3)
    many = [replace(one, cloud=one.cloud.select(one.cloud.frame % 4 < int(one.name[-1]) + 1)) for one in windows]
    found = median_windows(many)
    assert {label: one.name[-1] for label, one in found.items()} == {"rest": "1", "to_and_fro": "1"}
    draw(found, found, tmp_path / "a.png", seconds=2.0, wide=1.0)
    assert (tmp_path / "a.png").stat().st_size > 1000
