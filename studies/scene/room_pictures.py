"""Pictures of rooms: a sheet of all kinds, and what is recognised in rooms compared with the ground truth.

python -m studies run room_pictures --rooms /path/to/rooms --out docs/images
"""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.records import Scene
from mmweaver.scene.procedural.arrangement import KINDS
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.scene.top_view import draw_top
from studies.study import Reads

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = (
    ("office", 2, 21),
    ("living_room", 1, 22),
    ("kitchen", 3, 23),
    ("dining_room", 0, 24),
    ("bedroom", 4, 25),
    ("lab", 2, 26),
)
_PHOTO_PX = 400


def draw_sheet(path: Path, *, seed: int = 0, layouts: tuple[int, ...] = (0, 1)) -> None:
    """Photos of every kind, in as many layouts, under the lightings in turn."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    lightings, columns = list(LIGHTINGS), 6
    cells = [(kind, layout) for layout in layouts for kind in KINDS]
    rows = -(-len(cells) // columns)
    figure = Figure(figsize=(2.2 * columns, 1.8 * rows), layout="constrained")
    FigureCanvasAgg(figure)
    for index, (axes, (kind, layout)) in enumerate(zip(figure.subplots(rows, columns).ravel(), cells, strict=False)):
        axes.imshow(small(make_room(kind, layout, seed).photo(lightings[(index + layout) % 4]).rgb))
        axes.set_title(f"{kind}, layout {layout}", fontsize=8)
        axes.axis("off")
    save_small(figure, path)


def draw_found(path: Path, pairs: list[tuple[str, Scene, Scene | None]]) -> None:
    """Photo with seats and landmarks, and the room from above, two rooms a row."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows = -(-len(pairs) // 2)
    figure = Figure(figsize=(10.6, 2.75 * rows), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, 4, squeeze=False, width_ratios=(1.25, 1.25, 1.25, 1.25))
    for index, (name, scene, truth) in enumerate(pairs):
        left, right = axes[index // 2, 2 * (index % 2)], axes[index // 2, 2 * (index % 2) + 1]
        height, width = scene.photo.rgb.shape[:2]
        left.imshow(small(scene.photo.rgb), extent=(-0.5, width - 0.5, height - 0.5, -0.5))
        left.set_title(name, fontsize=8)
        for seat in scene.seats:
            _mark(left, scene, seat.position_m, "seat", "#d1495b")
        for mark in scene.landmarks:
            _mark(left, scene, mark.position_m, mark.kind, "#2e6f95")
        left.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xticks=[], yticks=[])
        draw_top(right, scene, truth=truth)
    save_small(figure, path)


def _mark(axes: "Axes", scene: Scene, place_m: np.ndarray, word: str, colour: str) -> None:
    column, row = AlignedPhoto.of(scene).project(place_m[None])[0][0]
    if np.isfinite(column):
        axes.text(
            column, row, word, fontsize=6, color="white", ha="center", clip_on=True,
            bbox={"facecolor": colour, "edgecolor": "none", "pad": 1.2},
        )  # fmt: skip


def small(rgb: np.ndarray) -> np.ndarray:
    """A picture subsampled to the size of a page."""
    from PIL import Image

    image = Image.fromarray(rgb)
    image.thumbnail((_PHOTO_PX, _PHOTO_PX))
    return np.asarray(image)


def save_small(figure: "Figure", path: Path, most_bytes: int = 300_000) -> None:
    """Writes a PNG of at most 256 colours, with fewer until it fits."""
    import io

    from PIL import Image

    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    image = Image.open(buffer).convert("RGB")
    for scale, colours in ((1.0, 256), (1.0, 128), (1.0, 64), (0.85, 128), (0.75, 64)):
        buffer = io.BytesIO()
        size = (round(image.width * scale), round(image.height * scale))
        image.resize(size).quantize(colours, dither=Image.Dither.NONE).save(buffer, format="png", optimize=True)
        if buffer.tell() <= most_bytes:
            break
    with atomic_file(path) as temporary:
        temporary.write_bytes(buffer.getvalue())


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, default=None, help="folder of the real rooms")
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    draw_sheet(options.out / "rooms_procedural.png")
    made = [(make_room(*key), f"{key[0]}, noisy depth alone") for key in SHOWN]
    found: list[tuple[str, Scene, Scene | None]] = []
    for index, (room, name) in enumerate(made):
        photo = room.photo(list(LIGHTINGS)[index % 4], noise=True)
        unnamed = type(photo)(rgb=photo.rgb, depth_m=photo.depth_m, intrinsics=photo.intrinsics)
        found.append((name, reconstruct(unnamed), room.scene()))
    draw_found(options.out / "rooms_found_procedural.png", found)
    if options.rooms is not None:
        real = []
        for folder in sorted(path for path in options.rooms.iterdir() if (path / "camera.json").is_file()):
            photo, _ = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
            real.append((folder.name, reconstruct(photo), None))
        draw_found(options.out / "rooms_found_real.png", real)
