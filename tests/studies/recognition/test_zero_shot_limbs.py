"""Which windows are the faint ones."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from studies.recognition.zero_shot_limbs import limb_strengths, thirds
from studies.recognition.zero_shot_recipe import radhar_recipe
from studies.recognition.zero_shot_scores import first_draws


def test_thirds_are_alike_in_number():
    assert np.bincount(thirds(np.random.default_rng(0).random(99))).tolist() == [33, 33, 33]


def test_each_window_has_its_own_draw():
    recipe = radhar_recipe()
    labels = tuple(recipe.activities)
    none = np.zeros(0)
    cloud = PointCloud(
        frame=none.astype(int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none
    )  # fmt: skip
    windows = [
        PointRecording(name=f"{label}_8_{index}", cloud=cloud, num_frames=60, frame_rate_hz=30.0, label=label)
        for index in (1, 0)
        for label in reversed(labels)
    ]
    draws = first_draws(recipe, 2, seed=8)
    wanted = [
        draws[index * len(labels) + labels.index(label)].legs_db for index in (1, 0) for label in reversed(labels)
    ]
    assert limb_strengths(windows, draws, labels, "legs_db").tolist() == wanted
