"""Pretrained segmenters: tiny ones, saved as published ones are, and loaded from the folder."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.segmentation import pretrained_segmenter
from mmweaver.scene.segmentation.pretrained_segmenter import relabelled, sam_masks, segment
from tests.scene import models

pytest.importorskip("transformers")
RGB = np.random.default_rng(0).integers(0, 255, (48, 80, 3), dtype=np.uint8)
KNOWN = {0, *(NAMES.index(name) for name in ("wall-other", "floor-other", "couch", "window-other"))}


@pytest.mark.parametrize("make", [models.segformer, models.mask2former])
def test_every_model_family_gives_classes_of_coco_stuff(tmp_path: Path, make):
    mask = segment(RGB, make(tmp_path / "model"))
    assert mask.index.shape == RGB.shape[:2]
    assert mask.names == NAMES
    assert set(np.unique(mask.index).tolist()) <= KNOWN
    again = segment(RGB, str(tmp_path / "model"))
    assert np.array_equal(mask.index, again.index)


def test_sams_masks_are_masks_of_the_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(pretrained_segmenter, "MIN_IOU", -10.0)  # random weights are certain of nothing
    monkeypatch.setattr(pretrained_segmenter, "MAX_SHARE", 1.1)
    masks = sam_masks(RGB, models.sam(tmp_path / "sam"))
    assert len(masks) > 0
    assert all(mask.shape == RGB.shape[:2] and mask.dtype == bool for mask in masks)
    sizes = [int(mask.sum()) for mask in masks]
    assert sizes == sorted(sizes, reverse=True)
    mask = segment(RGB, models.segformer(tmp_path / "model"), str(tmp_path / "sam"))
    assert set(np.unique(mask.index).tolist()) <= KNOWN


def test_a_mask_takes_the_class_of_its_majority():
    index = np.zeros((10, 10), np.uint8)
    index[:, :5], index[:, 5:] = 63, 172
    large, small, mixed = (np.zeros((10, 10), bool) for _ in range(3))
    large[:, :6], small[0, 4:6], mixed[9, 2:8] = True, True, True
    out = relabelled(index, [large, mixed, small])
    assert (out[1:9, :6] == 63).all()
    assert (out[1:9, 6:] == 172).all()
    assert out[9, 7] == 172  # half and half: left as it was


def test_other_models_are_refused(tmp_path: Path):
    with pytest.raises(InputError, match="does not segment"):
        segment(RGB, models.depth_anything(tmp_path / "depth"))
    with pytest.raises(InputError, match="not a SAM"):
        sam_masks(RGB, models.segformer(tmp_path / "segformer"))
    with pytest.raises(InputError, match="LABEL_0"):
        segment(RGB, models.segformer(tmp_path / "dumb", {0: "LABEL_0", 1: "LABEL_1"}))
