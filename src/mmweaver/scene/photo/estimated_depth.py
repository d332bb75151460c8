"""Monocular depth for photos without depth, by pretrained metric models such as Depth Anything.

Loads pretrained models through `transformers`, from a local folder or from the Hub.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import hub_log_off, need
from mmweaver.core.shapes import Array, DepthPixels, RgbPixels


def load_pretrained(source: str, option: str, choose: Callable[[Any, Any], Any]) -> tuple[Any, Any, Any]:
    """Loads a pretrained model for inference on the CPU; safetensors only.

    Args:
        source: Folder or Hub name.
        option: Command-line option, for error messages.
        choose: Called with the `transformers` module and the config; returns the class to load.

    Returns:
        Config, image processor and model in evaluation mode.

    Raises:
        InputError: If `transformers` is missing or the model cannot be loaded.
    """
    need("pretrained", option, "transformers")
    import transformers

    folder = Path(source)
    if folder.is_dir() and not (folder / "config.json").is_file():
        raise InputError(f"{option} {source} is a folder without config.json; give one written by save_pretrained")
    if not folder.is_dir() and (folder.exists() or source.startswith((".", "/", "~"))):
        raise InputError(f"{option} {source} is not a folder; give a model's folder or its name on the Hub")
    with quiet(transformers):
        try:
            config = transformers.AutoConfig.from_pretrained(source)
            model_class = choose(transformers, config)
            processor = transformers.AutoImageProcessor.from_pretrained(source)
            model = model_class.from_pretrained(source, use_safetensors=True)
        except InputError:
            raise
        except Exception as error:  # third-party files may fail in any way
            if isinstance(error, MemoryError):
                raise
            raise InputError(_load_error(source, option, error, is_folder=folder.is_dir())) from None
    return config, processor, model.eval()


@contextmanager
def quiet(transformers: Any) -> Iterator[None]:
    """Silences the log lines and progress bars of transformers."""
    logging = transformers.utils.logging
    level = logging.get_verbosity()
    logging.set_verbosity_error()
    logging.disable_progress_bar()
    try:
        with hub_log_off():
            yield
    finally:
        logging.set_verbosity(level)
        logging.enable_progress_bar()


def _load_error(source: str, option: str, error: Exception, *, is_folder: bool) -> str:
    reason = (str(error).strip().splitlines() or [type(error).__name__])[0][:160]
    if is_folder:
        return (
            f"{option} {source} cannot be loaded ({reason}); it needs config.json, preprocessor_config.json and"
            " model.safetensors"
        )
    return (
        f"{option} {source} is not a local folder and cannot be downloaded from the Hub ({reason}); with a network:"
        f" hf download {source} --local-dir DIR, then {option} DIR"
    )


EXAMPLE = "depth-anything/Depth-Anything-V2-Metric-Indoor-Small-hf"
AUTO = "auto"  # stands for EXAMPLE, downloaded once and kept in the Hub's cache
PROMPTED = "prompt_depth_anything"
PLAUSIBLE_HEIGHT_M = (0.6, 2.2)  # of a hand-held or mounted camera above the floor
ALWAYS_METRIC = {"zoedepth", "depth_pro"}
SOMETIMES_METRIC = {"depth_anything", PROMPTED}


@dataclass(frozen=True, kw_only=True)
class EstimatedDepth:
    """Depth estimated by a model."""

    depth_m: DepthPixels  # along the optical axis, nan where the model gives none above 5 cm
    focal_px: float | None  # for models that estimate it, such as Depth Pro
    model: str


def estimate_depth(
    rgb: RgbPixels, source: str, *, measured_m: Float[Array, "rows columns"] | None = None
) -> EstimatedDepth:
    """Estimates the depth of a picture with a pretrained metric model.

    Args:
        rgb: Picture, uint8, (height, width, 3).
        source: Folder of the model, its Hub name, or AUTO for `EXAMPLE`.
        measured_m: Coarse depth of the same view in metres, such as a phone's LiDAR measures, for models that take it
            as a prompt.

    Returns:
        Depth along the optical axis and, from models that estimate it, the focal length.

    Raises:
        InputError: If the model cannot be loaded, its depth is not metric, or it takes no prompt.
    """
    import torch
    from PIL import Image

    source = EXAMPLE if source == AUTO else source
    config, processor, model = load_pretrained(source, "--depth", _depth_class)
    height, width = rgb.shape[:2]
    prompt: dict[str, Any] = {}
    if measured_m is not None:
        if config.model_type != PROMPTED:
            raise InputError(
                f"--depth {source} takes no measured depth; leave out the depth or the model, or give a"
                " Prompt Depth Anything"
            )
        prompt = {"prompt_depth": np.nan_to_num(measured_m).astype(np.float32), "prompt_scale_to_meter": 1.0}
    try:
        inputs = processor(images=Image.fromarray(rgb), return_tensors="pt", **prompt)
        with torch.inference_mode():
            outputs = model(**inputs)
        said = processor.post_process_depth_estimation(outputs, target_sizes=[(height, width)])[0]
        found, focal = said["predicted_depth"], said.get("focal_length")
    except (ValueError, TypeError, RuntimeError) as error:
        raise InputError(f"--depth {source} cannot process this picture ({error}); try another model") from None
    depth_m = np.asarray(found.cpu().numpy(), dtype=float).reshape(height, width)
    measured = np.isfinite(depth_m) & (depth_m > 0.05)
    if not measured.any():
        raise InputError(f"--depth {source} gives no depth for this picture; try another model")
    focal_px = None if focal is None else float(focal)
    if focal_px is not None and not 0.2 * width <= focal_px <= 10 * width:
        focal_px = None
    return EstimatedDepth(depth_m=np.where(measured, depth_m, np.nan), focal_px=focal_px, model=source)


def scale_note(camera_height_m: float) -> str | None:
    """Warns if the estimated depth implies an implausible camera height.

    Args:
        camera_height_m: Height of the camera above the floor in metres.

    Returns:
        A sentence outside 0.6 to 2.2 m, else None.
    """
    low_m, high_m = PLAUSIBLE_HEIGHT_M
    if low_m <= camera_height_m <= high_m:
        return None
    return (
        f"By the estimated depth the camera is {camera_height_m:.2f} m above the floor; most are at {low_m:g} to"
        f" {high_m:g} m, so all distances are probably off by about that ratio."
    )


def _depth_class(transformers: Any, config: Any) -> Any:
    kind = config.model_type
    is_metric = kind in ALWAYS_METRIC or getattr(config, "depth_estimation_type", "") == "metric"
    if kind in SOMETIMES_METRIC and not is_metric:
        raise InputError(f"--depth: this {kind} model gives relative depth; use a metric one, such as {EXAMPLE}")
    if kind not in ALWAYS_METRIC | SOMETIMES_METRIC:
        known = ", ".join(sorted(ALWAYS_METRIC | SOMETIMES_METRIC))
        raise InputError(f"--depth: a {kind} model gives no metric depth; known: {known}; for example {EXAMPLE}")
    return transformers.AutoModelForDepthEstimation
