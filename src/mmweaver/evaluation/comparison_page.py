"""Files of a comparison: picture, JSON, and a self-contained HTML page with picture and table."""

import json
from base64 import b64encode
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.core.atomic_files import atomic_files
from mmweaver.core.output_checks import check_output_file
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes
from mmweaver.evaluation.comparison_picture import draw_comparison

if TYPE_CHECKING:
    from mmweaver.evaluation.compare_signals import Comparison

PICTURE, NUMBERS, PAGE = "comparison.png", "comparison.json", "comparison.html"
MAX_PICTURE_BYTES = 20 * MEGABYTE

_HTML = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>{title}</title>
<style>body{{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:78rem;padding:0 1rem;color:#22262b}}
pre{{overflow-x:auto}} img{{max-width:100%}}</style></head>
<body><h1>B compared with A</h1>
<img src="data:image/png;base64,{picture}" alt="Maps of A and B on the same axes and decibels, their static clutter
along range, their points from above, and effect sizes of the features">
<h2>What separates A and B</h2>
<p>Effect size: difference of the medians over the spread of the frames and the tolerance of the feature, with the
95 % interval of a bootstrap. Starred: the whole interval lies beyond 1. AUC: area under the ROC curve of this feature
alone, over frames; 50 % where A and B are alike.</p>
<pre>{table}</pre></body></html>
"""


def check_comparison_folder(out: Path, *, overwrite: bool, inputs: Iterable[Path] = ()) -> list[Path]:
    """Checks the files that a comparison will write.

    Args:
        out: The folder.
        overwrite: Whether they may exist.
        inputs: Files that must not be replaced. Default: none.

    Returns:
        Paths of the files.

    Raises:
        InputError: If one exists without `overwrite`, cannot be written, or belongs to an input.
    """
    paths = [out / name for name in (PICTURE, NUMBERS, PAGE)]
    for path in paths:
        check_output_file(path, overwrite=overwrite, inputs=inputs)
    return paths


def write_comparison(comparison: "Comparison", out: Path, *, overwrite: bool) -> list[Path]:
    """Writes the three files of a comparison, all or none.

    Args:
        comparison: The comparison.
        out: The folder.
        overwrite: Whether they may exist.

    Returns:
        Paths of the files.

    Raises:
        InputError: If one exists without `overwrite`, or cannot be written.
    """
    paths = check_comparison_folder(out, overwrite=overwrite)
    with atomic_files(*paths) as (picture, numbers, page):
        draw_comparison(comparison, picture)
        values = json.dumps(comparison.to_values(), indent=2, allow_nan=False, ensure_ascii=False)
        numbers.write_text(f"{values}\n", encoding="utf-8")
        page.write_text(html_page(comparison, read_bytes(picture, max_bytes=MAX_PICTURE_BYTES)), encoding="utf-8")
    return paths


def html_page(comparison: "Comparison", picture: bytes) -> str:
    """Formats the HTML page.

    Args:
        comparison: The comparison.
        picture: Content of the PNG, which is embedded.

    Returns:
        HTML text.
    """
    title = f"{comparison.sides[1].name} against {comparison.sides[0].name}"
    return _HTML.format(title=escape(title), picture=b64encode(picture).decode(), table=escape(comparison.text()))
