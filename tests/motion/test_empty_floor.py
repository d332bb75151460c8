import numpy as np
import pytest
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.motion.compose import Motion
from mmweaver.motion.empty_floor import act_out, empty_floor
from mmweaver.motion.language.plan import Step


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


def test_walking_turning_and_walking_on_is_one_gait():
    """No joint is thrown about where a turn meets a walk: at most what a walk has."""
    for seed in range(6):
        pose = act_out("walks, turns around, then walks back", duration_s=6.0, seed=seed).pose
        acceleration = np.linalg.norm(np.diff(pose.joints_m, 2, axis=0), axis=-1) * 120**2
        assert acceleration.max() < 135


@pytest.mark.parametrize(("sentence", "turned_rad"), [("turns left", np.pi / 2), ("waves", 0.0)])
def test_who_walks_on_goes_where_the_body_faces(sentence: str, turned_rad: float):
    for seed in range(4):
        motion = act_out(f"a person walks, {sentence} and walks on", seed=seed)
        before, after = (_way_m(motion, motion.plan.steps[k]) for k in (0, -1))
        angle_rad = np.arctan2(before[0] * after[1] - before[1] * after[0], before @ after)
        assert abs(angle_rad - turned_rad) < 0.2


def _way_m(motion: Motion, step: Step) -> Float[np.ndarray, "2"]:
    """From where to where the pelvis moves in a step, as (x, y) in metres."""
    start, end = np.searchsorted(motion.pose.time_s, [step.start_s, step.end_s - 0.1])
    return motion.pose.joints_m[end, 0, :2] - motion.pose.joints_m[start, 0, :2]


@pytest.mark.parametrize("text", ["paces back and forth", "walks to and fro slowly", "runs back and forth"])
def test_who_paces_comes_back(text: str):
    for seed in range(3):
        pelvis_m = act_out(f"a person {text}", seed=seed).pose.joints_m[:, 0, :2]
        way_m = float(np.linalg.norm(np.diff(pelvis_m, axis=0), axis=-1).sum())
        farthest_m = float(np.linalg.norm(pelvis_m - pelvis_m[0], axis=-1).max())
        assert way_m > 1.5 * farthest_m
