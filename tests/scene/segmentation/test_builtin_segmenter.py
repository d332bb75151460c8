"""The built-in segmenter."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.coco_stuff import NAMES, SEGMENTER_GROUPS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.segmentation.builtin_segmenter import (
    GROUP_NAMES,
    WEIGHTS,
    group_of_classes,
    load_network,
    segment_builtin,
)


def test_groups_are_classes_of_coco_stuff_and_each_class_is_in_one():
    members = [name for group in SEGMENTER_GROUPS for name in group]
    assert set(members) <= set(NAMES)
    assert len(members) == len(set(members))
    assert group_of_classes(("couch", "pillow", "person")).tolist() == [GROUP_NAMES.index("couch")] * 2 + [0]


def test_it_finds_floor_and_walls_in_an_unseen_kind_of_room():
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


def test_weights_are_small_and_corrupt_files_are_refused(tmp_path: Path):
    assert WEIGHTS.stat().st_size < 3_000_000
    (tmp_path / "weights.safetensors").write_bytes(b"a pickle of something else")
    with pytest.raises(InputError, match="no safetensors file"):
        load_network(tmp_path / "weights.safetensors")
    with pytest.raises(InputError, match="cannot read"):
        load_network(tmp_path / "none.safetensors")
