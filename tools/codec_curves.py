"""Draws rate against error in active cells for every recording of study `codec_cuts`: docs/images/codec_curves.png.

python tools/codec_curves.py
"""

import argparse
import json
from io import BytesIO
from pathlib import Path

from matplotlib import pyplot as plt
from matplotlib.lines import Line2D
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
OURS, COLUMNS, METRIC = "mmw", 5, "nmse_active_db"
SIZES_KB = (2.5, 10, 40)
Curves = dict[str, dict[str, list[tuple[int, float]]]]  # of each recording, of each codec: bytes and dB


def curves(results: Path) -> Curves:
    """All results of the study."""
    found: Curves = {}
    for path in sorted((results / "codec_cuts").glob("*.json")):
        for row in json.loads(path.read_text(encoding="utf-8"))["rows"]:
            error = row["metrics"][METRIC]["value"]
            if error is not None:
                codecs = found.setdefault(row["dataset"]["name"], {})
                codecs.setdefault(path.stem, []).append((row["size"]["bytes"], error))
    return found


def draw(found: Curves, out: Path) -> None:
    """One small diagram a recording, ours in colour over the others in grey."""
    plt.rcParams.update({"font.size": 7})
    rows = -(-len(found) // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(12, 1.9 * rows + 0.6), sharex=True, layout="constrained")
    marker = dict(
        zip(sorted({codec for codecs in found.values() for codec in codecs} - {OURS}), "os^vD*Xp", strict=False)
    )
    lines: dict[str, Line2D] = {}
    for axis in axes.flat[len(found) :]:
        axis.set_visible(False)
    for axis, (name, codecs) in zip(axes.flat, found.items(), strict=False):
        for codec, points in sorted(codecs.items(), key=lambda pair: pair[0] == OURS):
            kilobytes, error_db = zip(*[(size / 1000, error) for size, error in sorted(points)], strict=True)
            style = {"color": "tab:red", "lw": 1.8} if codec == OURS else {"color": "0.6", "lw": 0.8}
            lines[codec] = axis.plot(kilobytes, error_db, marker.get(codec, "o") + "-", ms=3.5, **style)[0]
        axis.set(title=name.replace(" of ", " of\n") if len(name) > 34 else name, xscale="log", ylim=(None, 5))
        axis.set_xticks(SIZES_KB, labels=SIZES_KB)
        axis.minorticks_off()
    figure.legend(
        [lines[codec] for codec in (OURS, *marker)],
        [f".{OURS}", *marker],
        loc="outside upper center",
        ncols=len(lines),
        fontsize=9,
    )
    figure.supxlabel("KB")
    figure.supylabel("error in active cells, dB")
    with BytesIO() as whole:
        figure.savefig(whole, dpi=90)
        Image.open(whole).convert("P", palette=Image.Palette.ADAPTIVE, colors=64).save(out, optimize=True)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__).parse_args()
    draw(curves(ROOT / "results"), ROOT / "docs" / "images" / "codec_curves.png")
