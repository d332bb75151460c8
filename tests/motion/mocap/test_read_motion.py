"""One motion under every convention of files comes back the same; what is missing is asked for in one line."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from mocap_files import walk, write_bvh, y_up

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.read_motion import read_motion


def shape_of(joints: np.ndarray) -> np.ndarray:
    """What stays the same wherever a motion stands: distances from the first pelvis, and heights."""
    return np.linalg.norm(joints - joints[:1, :1], axis=-1)


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.001, 0.0254])
@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("kind", ["bvh", "npy"])
def test_units_axes_and_kinds(tmp_path: Path, kind: str, up: str, unit: float):
    theirs = (y_up(walk()) if up == "y" else walk()) / unit
    path = tmp_path / f"walk.{kind}"
    if kind == "bvh":
        write_bvh(path, theirs)
        clip = read_motion(path)
    else:
        np.save(path, theirs)
        clip = read_motion(path, fps=60.0)
    assert clip.fps == pytest.approx(60.0)
    np.testing.assert_allclose(shape_of(clip.joints_m), shape_of(walk()), atol=1e-5)
    heights = clip.joints_m[..., 2] - clip.joints_m[0, 0, 2]
    np.testing.assert_allclose(heights, walk()[..., 2] - walk()[0, 0, 2], atol=1e-5)
    assert clip.file == path
    assert any("taken as" in note for note in clip.notes)
    assert any("upward axis" in note for note in clip.notes)


def test_what_is_said_wins(tmp_path: Path):
    np.save(tmp_path / "child.npy", walk() * 1.2)
    clip = read_motion(tmp_path / "child.npy", fps=30.0, unit="0.5", up="z")
    assert clip.height_m == pytest.approx(0.6 * 1.75, abs=0.02)
    assert clip.notes == ()


def test_a_mirrored_file_is_put_right(tmp_path: Path):
    np.save(tmp_path / "unity.npy", walk() * np.array([-1.0, 1.0, 1.0]))
    clip = read_motion(tmp_path / "unity.npy", fps=60.0, unit="m", up="z")
    np.testing.assert_allclose(clip.joints_m, walk())
    assert "mirrored" in clip.notes[0]


def test_what_cannot_be_read_is_refused_in_one_line(tmp_path: Path):
    np.save(tmp_path / "walk.npy", walk())
    np.save(tmp_path / "short.npy", walk()[:1])
    (tmp_path / "walk.fbx").write_text("x")
    for path, options, message in (
        ("none.bvh", {}, r"there is no motion file \S+none.bvh; give .*\.bvh"),
        ("walk.fbx", {}, r"read from \.bvh"),
        ("walk.npy", {}, "--motion-set fps="),
        ("walk.npy", {"fps": 0.0}, "frames per second"),
        ("walk.npy", {"fps": float("nan")}, "frames per second"),
        ("walk.npy", {"fps": 20.0, "unit": "yard"}, "unit of length"),
        ("walk.npy", {"fps": 20.0, "clip": "b"}, "--motion-set clip="),
        ("short.npy", {"fps": 20.0}, "1 frames"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            read_motion(tmp_path / path, **options)
        assert "\n" not in str(caught.value)


def test_a_pickle_is_told_as_such_and_no_advice_to_open_it(tmp_path: Path):
    (tmp_path / "walk.npz").write_bytes(pickle.dumps({"joints": 1}))
    with pytest.raises(InputError, match="is no plain") as caught:
        read_motion(tmp_path / "walk.npz")
    assert "allow_pickle" not in str(caught.value)
