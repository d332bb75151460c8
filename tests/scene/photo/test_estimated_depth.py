"""Monocular depth models."""

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

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


def test_measured_depth_is_for_models_that_take_it(tmp_path: Path):
    with pytest.raises(InputError, match="takes no measured depth"):
        estimate_depth(RGB, models.depth_anything(tmp_path / "model"), measured_m=np.ones((6, 10)))


def test_moge_gives_depth_and_focal_length(monkeypatch: pytest.MonkeyPatch):
    """A model of the interface that MoGe documents; the package itself is not on PyPI."""
    import torch

    def infer(picture: torch.Tensor) -> dict[str, torch.Tensor]:
        _, height, width = picture.shape
        depth = torch.full((height, width), 2.5)
        depth[0, 0] = torch.inf  # outside its mask
        return {"depth": depth, "intrinsics": torch.tensor([[0.8, 0, 0.5], [0, 1.3, 0.5], [0, 0, 1]])}

    module: Any = ModuleType("moge.model.v2")
    module.MoGeModel = SimpleNamespace(from_pretrained=lambda name: SimpleNamespace(infer=infer))
    for name in ("moge", "moge.model"):
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    monkeypatch.setitem(sys.modules, "moge.model.v2", module)
    found = estimate_depth(RGB, "moge")
    assert found.focal_px == pytest.approx(0.8 * RGB.shape[1])
    assert np.isnan(found.depth_m[0, 0])
    assert found.depth_m[1, 1] == 2.5
