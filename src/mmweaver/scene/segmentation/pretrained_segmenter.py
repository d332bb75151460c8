"""Semantic segmentation of a photo by pretrained models (SegFormer, MaskFormer, Mask2Former, ...), refined by SAM.

The models' own labels (ADE20K, COCO) are mapped to COCO-Stuff's classes, see `coco_stuff`.
"""

from typing import Any

import numpy as np
from jaxtyping import Bool, Float, UInt8

from mmweaver.core.errors import InputError
from mmweaver.core.records import ClassMask
from mmweaver.core.shapes import Array, ClassPixels, RgbPixels
from mmweaver.scene.coco_stuff import NAMES, coco_class
from mmweaver.scene.photo.estimated_depth import load_pretrained

UNIVERSAL = {"maskformer", "mask2former", "oneformer"}
SEMANTIC = {"segformer", "upernet", "beit", "dpt", "data2vec-vision", "mobilevit", "mobilevitv2", "mobilenet_v2"}
SAM = {"sam", "sam_hq"}
POINTS_ACROSS = 24  # of the grid of prompts for SAM, across the picture
BATCH_SIZE = 64
MIN_IOU = 0.8  # SAM's own estimate of a mask's overlap with the ground truth
MIN_SHARE, MAX_SHARE = 1e-4, 0.6  # of the picture: a larger mask is the room itself


def segment(rgb: RgbPixels, source: str, sam: str | None = None) -> ClassMask:
    """Segments a picture by a pretrained model.

    Args:
        rgb: Picture, uint8, (height, width, 3).
        source: Folder or Hub name of the model.
        sam: Folder or Hub name of a SAM model that refines the edges; None for none.

    Returns:
        Class mask in COCO-Stuff classes.

    Raises:
        InputError: If a model cannot be loaded, is not a segmenter, or has none of the known labels.
    """
    import torch

    config, processor, model = load_pretrained(source, "--classes", _segmenter_class)
    look_up = _look_up(source, config.id2label)
    height, width = rgb.shape[:2]
    inputs = _prepared(processor, rgb, source)
    with torch.inference_mode():
        outputs = model(**inputs)
        labels = processor.post_process_semantic_segmentation(outputs, target_sizes=[(height, width)])[0]
    index = look_up[np.clip(labels.cpu().numpy().astype(int), -1, len(look_up) - 2)]
    mask = ClassMask(index=index, names=NAMES)
    return mask if sam is None else refined_by_sam(mask, rgb, sam)


def refined_by_sam(mask: ClassMask, rgb: RgbPixels, sam: str) -> ClassMask:
    """Replaces the edges of a class mask by those of SAM's masks.

    Args:
        mask: Class mask.
        rgb: Picture, uint8, (height, width, 3).
        sam: Folder or Hub name of the SAM model.

    Returns:
        The refined mask.
    """
    return ClassMask(index=relabelled(mask.index, sam_masks(rgb, sam)), names=mask.names)


def sam_masks(rgb: RgbPixels, source: str) -> list[Bool[Array, "height width"]]:
    """SAM's masks prompted by a grid of points, the most certain mask of each point.

    Args:
        rgb: Picture, uint8, (height, width, 3).
        source: Folder or Hub name of the SAM model.

    Returns:
        Masks (height, width), the largest first.
    """
    import torch

    _, processor, model = load_pretrained(source, "sam", _sam_class)
    height, width = rgb.shape[:2]
    inputs = _prepared(processor, rgb, source)
    down = max(1, round(POINTS_ACROSS * height / width))
    columns = (np.arange(POINTS_ACROSS) + 0.5) / POINTS_ACROSS * width
    rows = (np.arange(down) + 0.5) / down * height
    points = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    shape = np.array(inputs["reshaped_input_sizes"][0].tolist()[::-1]) / (width, height)
    masks: list[np.ndarray] = []
    with torch.inference_mode():
        embeddings = model.get_image_embeddings(inputs["pixel_values"])
        for first in range(0, len(points), BATCH_SIZE):
            some = torch.tensor(points[first : first + BATCH_SIZE] * shape, dtype=torch.float32)[None, :, None]
            out = model(image_embeddings=embeddings, input_points=some, multimask_output=True)
            whole = processor.post_process_masks(
                out.pred_masks, inputs["original_sizes"], inputs["reshaped_input_sizes"]
            )[0].numpy()
            masks += _best(whole, out.iou_scores[0].numpy())
    return sorted(masks, key=lambda mask: -int(mask.sum()))


def relabelled(index: ClassPixels, masks: list[Bool[Array, "height width"]]) -> ClassPixels:
    """Assigns each mask the class of two thirds of its pixels, if any; smaller masks, which come later, overwrite.

    Args:
        index: Class of each pixel, (height, width).
        masks: Masks (height, width), the largest first.

    Returns:
        Corrected class of each pixel.
    """
    out = index.copy()
    for mask in masks:
        counts = np.bincount(index[mask], minlength=1)
        if counts.sum() and counts.max() >= 2 / 3 * counts.sum():
            out[mask] = np.argmax(counts)
    return out


def _best(masks: Bool[Array, "point mask height width"], iou: Float[Array, "point mask"]) -> list[np.ndarray]:
    """The mask of the highest estimated overlap at each point, where that and its size are acceptable."""
    found = []
    for point, best in enumerate(np.argmax(iou, axis=1)):
        mask = masks[point, best]
        if iou[point, best] >= MIN_IOU and MIN_SHARE < mask.mean() < MAX_SHARE:
            found.append(mask)
    return found


def _prepared(processor: Any, rgb: RgbPixels, source: str) -> Any:
    from PIL import Image

    try:
        return processor(images=Image.fromarray(rgb), return_tensors="pt")
    except (ValueError, TypeError, RuntimeError) as error:
        raise InputError(f"{source} cannot process this picture ({error}); try another model") from None


def _segmenter_class(transformers: Any, config: Any) -> Any:
    if config.model_type in UNIVERSAL:
        return transformers.AutoModelForUniversalSegmentation
    if config.model_type in SEMANTIC:
        return transformers.AutoModelForSemanticSegmentation
    known = ", ".join(sorted(UNIVERSAL | SEMANTIC))
    raise InputError(f"--classes: a {config.model_type} model does not segment; known: {known}")


def _sam_class(transformers: Any, config: Any) -> Any:
    if config.model_type in SAM:
        return transformers.AutoModelForMaskGeneration
    raise InputError(f"sam: a {config.model_type} model is not a SAM; known: {', '.join(sorted(SAM))}")


def _look_up(source: str, labels: dict[int, str]) -> UInt8[Array, " label"]:
    """COCO-Stuff's index of each of the model's labels, 0 for none; the last entry, which -1 selects, is 0."""
    numbers = np.zeros(max(map(int, labels)) + 2, np.uint8)
    for label, text in labels.items():
        name = coco_class(text)
        if name is not None:
            numbers[int(label)] = NAMES.index(name)
    if not numbers.any():
        some = ", ".join(repr(text) for text in list(labels.values())[:3])
        raise InputError(
            f"the labels of {source} ({some}, ...) are not those of COCO-Stuff or ADE20K; set its id2label names"
        )
    return numbers
