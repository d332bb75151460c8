"""Motion models behind one protocol."""

import sys
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_placement import facing_of
from mmweaver.motion.motion_models import MotionTask, clip_of, heading_of, load_motion_model


def slide(task: MotionTask) -> MotionClip:
    """A standing body moved along the path, as a model with path constraints would."""
    joints = act_out("a person stands", duration_s=1.0, height_m=1.75).pose.joints_m[2::12].copy()
    seconds = task.seconds or 2.0
    path = np.array(task.path_m or [(0.0, 2.0), (0.0, 1.0)])
    share = np.linspace(0, 1, int(20 * seconds))
    along = np.stack([np.interp(share, np.linspace(0, 1, len(path)), path[:, axis]) for axis in (0, 1)], axis=1)
    body = joints[0] - [*joints[0, 0, :2], 0.0]
    moved = np.repeat(body[None], len(share), axis=0)
    moved[..., :2] += along[:, None]
    return MotionClip(joints_m=moved, fps=20.0, label=task.sentence)


def test_a_model_of_any_module_is_loaded_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "sliding_model.py").write_text("from tests_slide import slide\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setitem(sys.modules, "tests_slide", sys.modules[__name__])
    model = load_motion_model("sliding_model:slide")
    path = ((0.0, 3.0), (0.5, 2.0), (0.0, 1.0))
    clip = clip_of(model, MotionTask(sentence="slides", path_m=path, seconds=3.0))
    assert clip.joints_m.shape == (60, 22, 3)
    np.testing.assert_allclose(clip.joints_m[[0, -1], 0, :2], [path[0], path[-1]], atol=1e-6)
    assert heading_of((), clip) is None


def test_the_way_of_a_model_s_motion_begins_as_the_path_whatever_the_body_faces():
    path = ((0.0, 3.0), (0.5, 2.0))
    for at, goes in ((path, True), ((path[0], path[0]), False)):
        clip = slide(MotionTask(sentence="slides", path_m=at, seconds=3.0))
        heading_rad = heading_of(((0.2, 1.5), (0.9, 1.5)), clip)  # to the right, on another path
        assert heading_rad is not None
        turned_rad = heading_rad - facing_of(clip.joints_m[0])
        want_rad = 0.0 - np.arctan2(-1.0, 0.5) if goes else heading_rad - facing_of(clip.joints_m[0])
        assert np.angle(np.exp(1j * (turned_rad - want_rad))) == pytest.approx(0, abs=1e-6)
        assert goes or heading_rad == pytest.approx(0.0)


def test_what_is_no_model_or_no_motion_is_refused():
    for name in ("no_such_module:model", "mmweaver.motion.motion_models:Place2"):
        with pytest.raises(InputError, match="cannot be imported"):
            load_motion_model(name)
    bad = MotionClip(joints_m=np.full((4, 22, 3), np.nan), fps=20.0, label="bad")
    with pytest.raises(InputError, match="not finite"):
        clip_of(lambda task: bad, MotionTask(sentence="x"))
    with pytest.raises(InputError, match="22, 3"):
        clip_of(lambda task: None, MotionTask(sentence="x"))
