"""The classes of COCO-Stuff, their aliases in other label sets, and the material that each implies.

Reference: COCO-Stuff labels.txt (Caesar et al. 2018); ADE20K's 150 names (Zhou et al. 2017); ITU-R P.2040-3, table 3.
"""

# The index is the class number in COCO-Stuff.
NAMES: tuple[str, ...] = (
    "unlabeled", "person", "bicycle", "car", "motorcycle", "airplane", "bus", "train", "truck", "boat",
    "traffic light", "fire hydrant", "street sign", "stop sign", "parking meter", "bench", "bird", "cat", "dog",
    "horse", "sheep", "cow", "elephant", "bear", "zebra", "giraffe", "hat", "backpack", "umbrella", "shoe",
    "eye glasses", "handbag", "tie", "suitcase", "frisbee", "skis", "snowboard", "sports ball", "kite", "baseball bat",
    "baseball glove", "skateboard", "surfboard", "tennis racket", "bottle", "plate", "wine glass", "cup", "fork",
    "knife", "spoon", "bowl", "banana", "apple", "sandwich", "orange", "broccoli", "carrot", "hot dog", "pizza",
    "donut", "cake", "chair", "couch", "potted plant", "bed", "mirror", "dining table", "window", "desk", "toilet",
    "door", "tv", "laptop", "mouse", "remote", "keyboard", "cell phone", "microwave", "oven", "toaster", "sink",
    "refrigerator", "blender", "book", "clock", "vase", "scissors", "teddy bear", "hair drier", "toothbrush",
    "hair brush", "banner", "blanket", "branch", "bridge", "building-other", "bush", "cabinet", "cage", "cardboard",
    "carpet", "ceiling-other", "ceiling-tile", "cloth", "clothes", "clouds", "counter", "cupboard", "curtain",
    "desk-stuff", "dirt", "door-stuff", "fence", "floor-marble", "floor-other", "floor-stone", "floor-tile",
    "floor-wood", "flower", "fog", "food-other", "fruit", "furniture-other", "grass", "gravel", "ground-other", "hill",
    "house", "leaves", "light", "mat", "metal", "mirror-stuff", "moss", "mountain", "mud", "napkin", "net", "paper",
    "pavement", "pillow", "plant-other", "plastic", "platform", "playingfield", "railing", "railroad", "river", "road",
    "rock", "roof", "rug", "salad", "sand", "sea", "shelf", "sky-other", "skyscraper", "snow", "solid-other", "stairs",
    "stone", "straw", "structural-other", "table", "tent", "textile-other", "towel", "tree", "vegetable", "wall-brick",
    "wall-concrete", "wall-other", "wall-panel", "wall-stone", "wall-tile", "wall-wood", "water-other", "waterdrops",
    "window-blind", "window-other", "wood",
)  # fmt: skip
UNLABELED = NAMES[0]
GLASS = frozenset({"window", "window-other"})  # a depth camera sees through it
MIRRORS = frozenset({"mirror", "mirror-stuff"})  # a depth camera sees the reflected room
SCREENS = frozenset({"tv", "laptop", "oven", "microwave"})  # dark panes, without depth
DOORS = frozenset({"door", "door-stuff"})
WALLS = frozenset(name for name in NAMES if name.startswith("wall-"))
# Rough surfaces: no specular reflection at a wavelength of 4 mm, however flat their fronts.
ROUGH = frozenset({
    "book", "shelf", "curtain", "cloth", "clothes", "towel", "blanket", "pillow", "potted plant", "plant-other",
    "flower", "leaves", "teddy bear", "backpack", "textile-other",
})  # fmt: skip

# The material that a class implies; for a class that is not listed, geometry and colour decide.
MATERIAL: dict[str, str] = {
    "wall-brick": "brick", "wall-concrete": "concrete", "wall-panel": "wood", "wall-stone": "concrete",
    "wall-tile": "marble", "wall-wood": "wood", "ceiling-tile": "ceiling_board", "floor-marble": "marble",
    "floor-stone": "concrete", "floor-tile": "marble", "floor-wood": "floorboard", "window": "glass",
    "window-other": "glass", "mirror": "metal", "mirror-stuff": "metal", "couch": "fabric", "bed": "fabric",
    "pillow": "fabric", "blanket": "fabric", "curtain": "fabric", "cloth": "fabric", "clothes": "fabric",
    "towel": "fabric", "textile-other": "fabric", "teddy bear": "fabric", "backpack": "fabric", "chair": "wood",
    "bench": "wood", "dining table": "wood", "desk": "wood", "desk-stuff": "wood", "table": "wood", "wood": "wood",
    "door": "wood", "door-stuff": "wood", "cabinet": "chipboard", "cupboard": "chipboard", "shelf": "chipboard",
    "furniture-other": "chipboard", "counter": "marble", "stone": "concrete", "tv": "glass", "laptop": "glass",
    "refrigerator": "metal", "oven": "metal", "microwave": "metal", "toaster": "metal", "sink": "metal",
    "metal": "metal", "railing": "metal", "toilet": "marble", "bottle": "glass", "vase": "glass",
}  # fmt: skip

# Names of other label sets (ADE20K, COCO panoptic) -> COCO-Stuff's.
ALIASES: dict[str, str] = {
    "wall": "wall-other", "floor": "floor-other", "flooring": "floor-other", "ceiling": "ceiling-other",
    "windowpane": "window-other", "sofa": "couch", "lounge": "couch", "armchair": "chair", "swivel chair": "chair",
    "seat": "chair", "stool": "chair", "ottoman": "chair", "coffee table": "table", "cocktail table": "table",
    "pool table": "table", "bookcase": "shelf", "bookshelf": "shelf", "wardrobe": "cupboard", "closet": "cupboard",
    "chest of drawers": "cabinet", "kitchen island": "counter", "countertop": "counter", "bar": "counter",
    "buffet": "counter", "case": "cabinet", "carpeting": "carpet", "drape": "curtain", "drapery": "curtain",
    "blind": "window-blind", "screen": "tv", "crt screen": "tv", "monitor": "tv", "television": "tv",
    "television receiver": "tv", "computer": "laptop", "stove": "oven", "range": "oven", "dishwasher": "oven",
    "dish washer": "oven", "icebox": "refrigerator", "washer": "oven", "cushion": "pillow", "plant": "plant-other",
    "flora": "plant-other", "flower": "potted plant", "pot": "vase", "flowerpot": "vase", "painting": "paper",
    "picture": "paper", "poster": "paper", "lamp": "light", "chandelier": "light", "sconce": "light",
    "light source": "light", "fireplace": "wall-brick", "hearth": "wall-brick", "column": "wall-other",
    "pillar": "wall-other", "screen door": "door-stuff", "stairway": "stairs", "staircase": "stairs",
    "step": "stairs", "bannister": "railing", "banister": "railing", "radiator": "metal", "apparel": "clothes",
    "wearing apparel": "clothes", "bag": "handbag", "basket": "straw", "box": "cardboard", "glass": "wine glass",
    "drinking glass": "wine glass", "toilet": "toilet", "can": "toilet", "bathtub": "toilet", "shower": "wall-tile",
    "hood": "metal", "exhaust hood": "metal", "desk": "desk", "double door": "door-stuff", "cradle": "bed",
    "sky": "sky-other", "building": "building-other", "tree": "tree", "ground": "ground-other", "water": "water-other",
}  # fmt: skip


def coco_class(label: str) -> str | None:
    """COCO-Stuff's name of a model's label, such as "sofa, couch, lounge" or "wall-other-merged"; None if it has none.

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
    """The material that a COCO-Stuff class implies; None where it implies none."""
    return MATERIAL.get(name)
