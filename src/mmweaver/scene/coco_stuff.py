"""The classes of COCO-Stuff, their aliases in other label sets, and what each implies: coco_stuff.toml."""

from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml

_TABLES = read_toml(Path(__file__).with_suffix(".toml"))
NAMES: tuple[str, ...] = tuple(_TABLES["names"])  # the index is the class number in COCO-Stuff
UNLABELED = NAMES[0]
GLASS = frozenset({"window", "window-other"})  # a depth camera sees through it
MIRRORS = frozenset({"mirror", "mirror-stuff"})  # a depth camera sees the reflected room
SCREENS = frozenset({"tv", "laptop", "oven", "microwave"})  # dark panes, without depth
DOORS = frozenset({"door", "door-stuff"})
WALLS = frozenset(name for name in NAMES if name.startswith("wall-"))
ROUGH, SITTABLE, NO_EVIDENCE = (frozenset(_TABLES[key]) for key in ("rough", "sittable", "no_evidence"))
SEGMENTER_GROUPS: tuple[tuple[str, ...], ...] = tuple(map(tuple, _TABLES["segmenter_groups"]))
CLASS_OF_MATERIAL: dict[str, str] = _TABLES["class_of_material"]


def _inverted(key: str) -> dict[str, str]:
    """A table of `coco_stuff.toml` inverted: from class to its entry."""
    return {name: value for value, names in _TABLES[key].items() for name in names}


MATERIAL, LANDMARKS, ALIASES = map(_inverted, ("materials", "landmarks", "aliases"))


def coco_class(label: str) -> str | None:
    """Maps a model's label to the COCO-Stuff class of the same meaning.

    Args:
        label: Label of any model, such as "sofa, couch, lounge" or "wall-other-merged"; synonyms separated by commas.

    Returns:
        The class name, or None if there is no equivalent.

    >>> coco_class("sofa, couch, lounge"), coco_class("ceiling-merged"), coco_class("LABEL_7")
    ('couch', 'ceiling-other', None)
    """
    words = [word.strip().lower().removesuffix("-merged") for word in label.replace(";", ",").split(",")]
    for word in words:
        if word in ALIASES:
            return ALIASES[word]
        if word in NAMES and word != UNLABELED:
            return word
    return None


def material_of(name: str) -> str | None:
    """The ITU-R P.2040 material implied by a COCO-Stuff class.

    Args:
        name: COCO-Stuff class.

    Returns:
        Name of the material, or None if the class implies none.
    """
    return MATERIAL.get(name)
