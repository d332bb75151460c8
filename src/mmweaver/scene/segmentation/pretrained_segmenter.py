"""What is what in a photo, by models of other people: SegFormer, MaskFormer, Mask2Former and their like; SAM's edges.

The models bring their own labels (ADE20K, COCO); they become COCO-Stuff's classes, see `coco_stuff`.
"""

from typing import Any

import numpy as np
from jaxtyping import Bool, Float, UInt8

from mmweaver.core.errors import InputError
from mmweaver.core.records import ClassMask
from mmweaver.core.shapes import Array, ClassPixels, RgbPixels
from mmweaver.scene.coco_stuff import NAMES, coco_class
from mmweaver.scene.photo.pretrained import load_pretrained

UNIVERSAL = {"maskformer", "mask2former", "oneformer"}
SEMANTIC = {"segformer", "upernet", "beit", "dpt", "data2vec-vision", "mobilevit", "mobilevitv2", "mobilenet_v2"}
SAM = {"sam", "sam_hq"}
POINTS_ACROSS = 24  # SAM is asked what lies at so many points across the picture
POINTS_AT_ONCE = 64
SURE = 0.8  # SAM's own estimate of a mask's overlap with the truth
LARGEST = 0.6  # of the picture: a mask above this is the room itself


def segment(rgb: RgbPixels, source: str, sam: str | None = None) -> ClassMask:
    """The classes of a picture by the model in a folder or on the Hub; `sam` sharpens their edges by SAM's masks.

    Raises InputError where a model cannot be loaded, is no segmenter, or has labels that mean nothing here.
    """
    import torch

    config, processor, model = load_pretrained(source, "--segmenter", _segmenter_class)
    look_up = _look_up(source, config.id2label)
    height, width = rgb.shape[:2]
    inputs = _prepared(processor, rgb, source)
    with torch.inference_mode():
        outputs = model(**inputs)
        labels = processor.post_process_semantic_segmentation(outputs, target_sizes=[(height, width)])[0]
    index = look_up[np.clip(labels.cpu().numpy().astype(int), -1, len(look_up) - 2)]
    mask = ClassMask(index=index, names=NAMES)
    return mask if sam is None else sharpened(mask, rgb, sam)


def sharpened(mask: ClassMask, rgb: RgbPixels, sam: str) -> ClassMask:
    """The same classes with the edges of SAM's masks."""
    return ClassMask(index=painted(mask.index, sam_masks(rgb, sam)), names=mask.names)


def sam_masks(rgb: RgbPixels, source: str) -> list[Bool[Array, "height width"]]:
    """SAM's masks at a grid of points, the surest first at each point, largest first in the list."""
    import torch

    _, processor, model = load_pretrained(source, "--sam", _sam_class)
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
        for first in range(0, len(points), POINTS_AT_ONCE):
            some = torch.tensor(points[first : first + POINTS_AT_ONCE] * shape, dtype=torch.float32)[None, :, None]
            out = model(image_embeddings=embeddings, input_points=some, multimask_output=True)
            whole = processor.post_process_masks(
                out.pred_masks, inputs["original_sizes"], inputs["reshaped_input_sizes"]
            )[0].numpy()
            masks += _best(whole, out.iou_scores[0].numpy())
    return sorted(masks, key=lambda mask: -int(mask.sum()))


def painted(index: ClassPixels, masks: list[Bool[Array, "height width"]]) -> ClassPixels:
    """Each mask gets the class that most of its pixels have, if two thirds do; later (smaller) masks lie on top."""
    out = index.copy()
    for mask in masks:
        counts = np.bincount(index[mask], minlength=1)
        if counts.sum() and counts.max() >= 2 / 3 * counts.sum():
            out[mask] = np.argmax(counts)
    return out


def _best(masks: Bool[Array, "point mask height width"], sure: Float[Array, "point mask"]) -> list[np.ndarray]:
    chosen = np.argmax(sure, axis=1)
    found = []
    for point, which in enumerate(chosen):
        mask = masks[point, which]
        share = mask.mean()
        if sure[point, which] >= SURE and 1e-4 < share < LARGEST:
            found.append(mask)
    return found


def _prepared(processor: Any, rgb: RgbPixels, source: str) -> Any:
    from PIL import Image

    try:
        return processor(images=Image.fromarray(rgb), return_tensors="pt")
    except (ValueError, TypeError, RuntimeError) as error:
        raise InputError(f"{source} cannot take this picture ({error}); try another model") from None


def _segmenter_class(transformers: Any, config: Any) -> Any:
    if config.model_type in UNIVERSAL:
        return transformers.AutoModelForUniversalSegmentation
    if config.model_type in SEMANTIC:
        return transformers.AutoModelForSemanticSegmentation
    known = ", ".join(sorted(UNIVERSAL | SEMANTIC))
    raise InputError(f"--segmenter: a {config.model_type} model gives no classes; known: {known}")


def _sam_class(transformers: Any, config: Any) -> Any:
    if config.model_type in SAM:
        return transformers.AutoModelForMaskGeneration
    raise InputError(f"--sam: a {config.model_type} model is no SAM; known: {', '.join(sorted(SAM))}")


def _look_up(source: str, labels: dict[int, str]) -> UInt8[Array, " label"]:
    """COCO-Stuff's number of each of the model's labels, and 0 for none (the last, which -1 picks)."""
    numbers = np.zeros(max(map(int, labels)) + 2, np.uint8)
    for label, text in labels.items():
        name = coco_class(text)
        if name is not None:
            numbers[int(label)] = NAMES.index(name)
    if not numbers.any():
        some = ", ".join(repr(text) for text in list(labels.values())[:3])
        raise InputError(
            f"the labels of {source} ({some}, ...) are none of COCO-Stuff or ADE20K; give its id2label names"
        )
    return numbers
