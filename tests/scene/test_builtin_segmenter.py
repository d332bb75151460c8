"""The segmenter that comes with the project."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.builtin_segmenter import (
    CHANNELS,
    GROUP_NAMES,
    GROUPS,
    WEIGHTS,
    grid_features,
    group_of_classes,
    load_network,
    segment_builtin,
)
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.depth_grid import make_grid
from mmweaver.scene.gravity import find_gravity
from mmweaver.scene.procedural.room import make_room
from mmweaver.scene.sample import sample_photo

pytest.importorskip("safetensors")


def test_groups_are_classes_of_coco_stuff_and_each_class_is_in_one():
    members = [name for group in GROUPS for name in group]
    assert set(members) <= set(NAMES)
    assert len(members) == len(set(members))
    assert group_of_classes(("couch", "pillow", "person")).tolist() == [GROUP_NAMES.index("couch")] * 2 + [0]


def test_features_tell_height_slope_and_what_was_measured():
    photo, _ = sample_photo()
    grid = make_grid(photo)
    gravity = find_gravity(grid)
    from mmweaver.geometry.rotations import level_from_camera

    features = grid_features(grid, level_from_camera(gravity.up_camera), gravity.floor_z_m)
    assert features.shape == (CHANNELS, *grid.depth_m[::2, ::2].shape)
    assert np.isfinite(features).all()
    assert np.array_equal(features[6] > 0, np.isfinite(grid.depth_m[::2, ::2]))
    bottom = features[:, -5:, 30:50]
    assert np.median(2.5 * bottom[3]) == pytest.approx(0.0, abs=0.03)
    assert np.median(bottom[4]) > 0.95


def test_it_finds_floor_and_walls_of_a_kind_of_room_it_never_saw():
    photo = make_room("dining_room", 0, 77).photo(noise=True)
    assert photo.classes is not None
    mask = segment_builtin(photo)
    truth = group_of_classes(photo.classes.names)[photo.classes.index]
    guess = group_of_classes(mask.names)[mask.index]
    for name, least in (("floor-other", 0.75), ("wall-other", 0.6)):
        group = GROUP_NAMES.index(name)
        both, either = (truth == group) & (guess == group), (truth == group) | (guess == group)
        assert both.sum() / either.sum() > least, name
    assert np.array_equal(segment_builtin(photo).index, mask.index)


def test_weights_are_small_and_rubbish_is_refused(tmp_path: Path):
    assert WEIGHTS.stat().st_size < 3_000_000
    (tmp_path / "weights.safetensors").write_bytes(b"a pickle of something else")
    with pytest.raises(InputError, match="no weights of the built-in segmenter"):
        load_network(tmp_path / "weights.safetensors")
    with pytest.raises(InputError, match="no weights"):
        load_network(tmp_path / "none.safetensors")
