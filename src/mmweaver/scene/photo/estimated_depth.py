"""Monocular depth for photos without depth, by pretrained metric models such as Depth Anything."""

from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import DepthPixels, RgbPixels
from mmweaver.scene.photo.pretrained import load_pretrained

EXAMPLE = "depth-anything/Depth-Anything-V2-Metric-Indoor-Small-hf"
ALWAYS_METRIC = {"zoedepth", "depth_pro"}
SOMETIMES_METRIC = {"depth_anything", "prompt_depth_anything"}


def estimate_depth(rgb: RgbPixels, source: str) -> DepthPixels:
    """Estimates depth in metres along the optical axis, (height, width); nan where the model gives none above 5 cm.

    Raises InputError where the model cannot be loaded or its depth is not metric.
    """
    import torch
    from PIL import Image

    _, processor, model = load_pretrained(source, "--depth-model", _depth_class)
    height, width = rgb.shape[:2]
    try:
        inputs = processor(images=Image.fromarray(rgb), return_tensors="pt")
        with torch.inference_mode():
            outputs = model(**inputs)
        found = processor.post_process_depth_estimation(outputs, target_sizes=[(height, width)])[0]["predicted_depth"]
    except (ValueError, TypeError, RuntimeError) as error:
        raise InputError(f"--depth-model {source} cannot process this picture ({error}); try another model") from None
    depth_m = np.asarray(found.cpu().numpy(), dtype=float).reshape(height, width)
    measured = np.isfinite(depth_m) & (depth_m > 0.05)
    if not measured.any():
        raise InputError(f"--depth-model {source} gives no depth for this picture; try another model")
    return np.where(measured, depth_m, np.nan)


def _depth_class(transformers: Any, config: Any) -> Any:
    kind = config.model_type
    is_metric = kind in ALWAYS_METRIC or getattr(config, "depth_estimation_type", "") == "metric"
    if kind in SOMETIMES_METRIC and not is_metric:
        raise InputError(f"--depth-model: this {kind} model gives relative depth; use a metric one, such as {EXAMPLE}")
    if kind not in ALWAYS_METRIC | SOMETIMES_METRIC:
        known = ", ".join(sorted(ALWAYS_METRIC | SOMETIMES_METRIC))
        raise InputError(f"--depth-model: a {kind} model gives no metric depth; known: {known}; for example {EXAMPLE}")
    return transformers.AutoModelForDepthEstimation
