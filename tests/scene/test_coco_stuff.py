"""Names of classes and their materials."""

import pytest

from mmweaver.propagation.materials import MATERIALS
from mmweaver.scene.coco_stuff import ALIASES, GLASS, MATERIAL, MIRRORS, NAMES, coco_class


def test_numbers_are_those_of_coco_stuff():
    """Some well-known numbers: 91 things up to hair brush, stuff from banner to wood."""
    assert len(NAMES) == 183
    assert len(set(NAMES)) == 183
    known = {"person": 1, "chair": 62, "couch": 63, "bed": 65, "tv": 72, "hair brush": 91, "banner": 92, "rug": 152,
             "wall-brick": 171, "window-other": 181, "wood": 182}  # fmt: skip
    assert {name: NAMES.index(name) for name in known} == known


def test_every_name_used_is_a_class_and_every_material_one_of_the_simulators():
    assert set(MATERIAL) | set(ALIASES.values()) | GLASS | MIRRORS <= set(NAMES)
    assert set(MATERIAL.values()) <= set(MATERIALS)
    assert all(coco_class(name) for name in NAMES[1:])


@pytest.mark.parametrize(
    ("label", "name"),
    [
        ("wall", "wall-other"), ("floor, flooring", "floor-other"), ("windowpane, window", "window-other"),
        ("sofa, couch, lounge", "couch"), ("chest of drawers, chest, bureau, dresser", "cabinet"),
        ("crt screen", "tv"), ("wall-brick", "wall-brick"), ("cabinet-merged", "cabinet"),
        ("mirror-stuff", "mirror-stuff"), ("Mirror", "mirror"), ("LABEL_12", None), ("", None), ("unlabeled", None),
    ],
)  # fmt: skip
def test_labels_of_ade20k_and_coco_panoptic(label: str, name: str | None):
    assert coco_class(label) == name
