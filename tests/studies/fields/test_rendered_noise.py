from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.dsp.points import point_cloud
from studies.fields.budgeted_fit import BudgetedRecipe
from studies.fields.field_signals import StudySignal
from studies.fields.rendered_noise import DEFINITIONS, far_points, noise_row, noise_scores
from studies.fields.sampling import finer_grid
from studies.fields.scatterer_field import ScattererField
from tests.fields.echoes import crowd


def test_rendered_noise_is_nearer_to_the_capture_than_none():
    signal = StudySignal(name="crowd", origin="simulated", cube=crowd(noise=2e-3), realization=None)
    metrics = noise_row(signal)["metrics"]
    assert set(metrics) == set(DEFINITIONS)
    assert abs(metrics["noise_floor_db"]["value"]) < 1.0
    assert metrics["noise_floor_db"]["baseline"]["without_noise"] < -3
    assert metrics["distribution_distance"]["value"] < 0.05


def test_a_cube_is_itself():
    scores = noise_scores(crowd(), crowd())
    assert scores["noise_floor_db"] == scores["distribution_distance"] == scores["false_points_a_frame"] == 0.0


def test_points_of_another_frame_are_far():
    cloud = point_cloud(crowd())
    moved = replace(cloud, frame=cloud.frame + 1)
    last = int(np.sum(moved.frame == moved.frame.max()))
    assert far_points(cloud, cloud) == 0
    assert far_points(moved, cloud) >= last > 0


def test_noise_between_the_cells_is_refused():
    cube = crowd()
    field = ScattererField.fit(cube, BudgetedRecipe(num_points=5, stages=2))
    finer = field.cube(finer_grid(cube.grid, n_r=2.0))
    with pytest.raises(InputError, match="native cells"):
        field.with_noise(finer, seed=0)
