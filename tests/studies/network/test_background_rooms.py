"""Pictures of rooms with and without a recording: the recording brings the truth's own room."""

from pathlib import Path

import numpy as np
from PIL import Image

from studies.network.background_rooms import draw_rooms, views_of


def test_the_recording_brings_the_room(tmp_path: Path):
    views = views_of("workshop", frames=16)
    still = [view.cube.values[:, :, view.cube.values.shape[2] // 2].mean(axis=0) for view in views]
    alike = [abs(np.vdot(one, still[0])) / np.linalg.norm(one) / np.linalg.norm(still[0]) for one in still[1:]]
    assert alike[1] > 0.95 > alike[0]
    draw_rooms(tmp_path / "rooms.png", [views])
    assert Image.open(tmp_path / "rooms.png").width > 1000
