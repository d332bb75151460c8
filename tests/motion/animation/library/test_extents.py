"""How high, how low and how far hands, feet, head and hips get in every activity, against the table in extents.toml."""

from pathlib import Path

import numpy as np
import pytest
from acted import acted

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.core.skeleton import joint
from mmweaver.motion.language.activities import BODY, HANDS

EXTENTS_CM = read_toml(Path(__file__).with_name("extents.toml"))
NAMED = [joint(name) for name in ("pelvis", "head", "left_wrist", "right_wrist", "left_foot", "right_foot")]


@pytest.mark.parametrize("text", EXTENTS_CM)
def test_joints_get_as_far_as_in_the_table(text: str):
    places = acted(text)[:, NAMED]
    low, high = places.min(axis=0), places.max(axis=0)
    extents_m = np.column_stack([low[:, 2], high[:, 2], np.hypot(*(high - low)[:, :2].T)])
    np.testing.assert_allclose(100 * extents_m.ravel(), EXTENTS_CM[text], atol=1.5)


def test_every_activity_is_in_the_table():
    assert {activity.example.removeprefix("a person ") for activity in (*BODY, *HANDS)} <= EXTENTS_CM.keys()
