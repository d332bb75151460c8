"""Monocular depth models."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.estimated_depth import estimate_depth
from tests.scene import models

pytest.importorskip("transformers")
RGB = np.random.default_rng(0).integers(0, 255, (48, 80, 3), dtype=np.uint8)


def test_a_metric_model_gives_metres(tmp_path: Path):
    found = estimate_depth(RGB, models.depth_anything(tmp_path / "model"))
    depth_m = found.depth_m
    assert found.focal_px is None
    assert depth_m.shape == RGB.shape[:2]
    assert np.isfinite(depth_m).any()
    assert np.nanmax(depth_m) <= 20.0
    assert np.nanmin(depth_m) > 0


def test_models_of_relative_depth_are_refused(tmp_path: Path):
    with pytest.raises(InputError, match="relative depth"):
        estimate_depth(RGB, models.depth_anything(tmp_path / "relative", "relative"))
    with pytest.raises(InputError, match="no metric depth"):
        estimate_depth(RGB, models.segformer(tmp_path / "segformer"))
