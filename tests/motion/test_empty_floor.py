import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.empty_floor import act_out, empty_floor


def test_a_sentence_without_a_photo():
    made = act_out("a person walks to the left, then waves", duration_s=4.0, seed=1, height_m=1.8)
    assert made.pose.height_m == 1.8
    assert [step.name for step in made.plan.steps] == ["walking", "waving"]
    assert made.pose.joints_m[-1, 0, 0] < made.pose.joints_m[0, 0, 0] - 0.8
    same = act_out("a person walks to the left, then waves", duration_s=4.0, seed=1, height_m=1.8)
    assert np.array_equal(same.pose.joints_m, made.pose.joints_m)
    assert empty_floor().floor.kind == "floor"
    with pytest.raises(InputError, match="photosynthesises"):
        act_out("a person photosynthesises", duration_s=2.0)


def test_what_a_sentence_goes_to_and_is_not_there_is_told():
    assert any("no door" in sentence for sentence in act_out("walks to the door", duration_s=3.0).assumptions)


def test_walking_turning_and_walking_on_is_one_gait():
    """No joint is thrown about where a turn meets a walk: at most what a walk has."""
    for seed in range(6):
        pose = act_out("walks, turns around, then walks back", duration_s=6.0, seed=seed).pose
        acceleration = np.linalg.norm(np.diff(pose.joints_m, 2, axis=0), axis=-1) * 120**2
        assert acceleration.max() < 135
