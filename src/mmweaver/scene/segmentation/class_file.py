"""Reads a class mask from a picture of class numbers."""

from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import ClassMask
from mmweaver.core.safe_files.safe_pictures import open_picture
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.scene.coco_stuff import NAMES, UNLABELED, coco_class


def read_class_file(path: Path, width: int, height: int) -> ClassMask:
    """Reads an 8-bit picture of class numbers.

    A .json of the same name, {"1": "couch", ...}, defines the numbers by names of COCO-Stuff or ADE20K; without it
    they are those of COCO-Stuff's pixel maps: class minus 1, 255 = unlabeled.

    Args:
        path: Grey or palette picture with the photo's size or aspect ratio.
        width: Columns of the photo.
        height: Rows of the photo.

    Returns:
        The mask at the photo's size.

    Raises:
        InputError: If the picture is not such a mask.
    """
    from PIL import Image

    image = open_picture(path).image
    if image.mode not in ("L", "P"):
        raise InputError(
            f"{path} is a picture of mode {image.mode}; class numbers need 8 bits a pixel (grey or palette)"
        )
    if abs(image.width / image.height / (width / height) - 1) > 0.01:
        raise InputError(
            f"{path} has {image.width} x {image.height} pixels, the photo {width} x {height}: not the same view"
        )
    if image.size != (width, height):
        image = image.resize((width, height), Image.Resampling.NEAREST)
    numbers = np.array(image)
    table = _table(path.with_suffix(".json")) if path.with_suffix(".json").is_file() else _coco_table()
    unknown = sorted(set(np.unique(numbers).tolist()) - set(table))
    if unknown:
        raise InputError(f"{path} has the class number {unknown[0]}, which {_source(path)} does not name")
    look_up = np.zeros(256, np.uint8)
    for number, name in table.items():
        look_up[number] = NAMES.index(name)
    return ClassMask(index=look_up[numbers], names=NAMES)


def _source(path: Path) -> str:
    table = path.with_suffix(".json")
    return str(table) if table.is_file() else f"COCO-Stuff (0 to 181, 255; or name them in {table.name})"


def _coco_table() -> dict[int, str]:
    return {number - 1: name for number, name in enumerate(NAMES) if number} | {255: UNLABELED}


def _table(path: Path) -> dict[int, str]:
    content: Any = read_json(path)
    try:
        pairs = [(int(number), str(label)) for number, label in content.items()]
    except (ValueError, AttributeError) as error:
        raise InputError(
            f'{path} is not a JSON object of numbers and names, such as {{"1": "couch"}} ({error})'
        ) from None
    table = {0: UNLABELED, 255: UNLABELED}
    for number, label in pairs:
        name = UNLABELED if label.lower() in (UNLABELED, "unknown", "void") else coco_class(label)
        if not 0 <= number <= 255 or name is None:
            raise InputError(
                f"{path}: {number} is {label!r}, which is not a class of COCO-Stuff, such as couch or wall-brick"
            )
        table[number] = name
    return table
