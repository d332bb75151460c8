"""The files of a comparison: picture, JSON, and one HTML page that holds both for any browser without a network."""

import json
from base64 import b64encode
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.comparison.comparison_picture import draw_comparison
from mmweaver.core.atomic_files import atomic_files
from mmweaver.core.output_checks import check_output_file
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes

if TYPE_CHECKING:
    from mmweaver.comparison.compare_signals import Comparison, FeatureComparison, SideFacts, SideValue

PICTURE, NUMBERS, PAGE = "comparison.png", "comparison.json", "comparison.html"
LARGEST_PICTURE = 20 * MEGABYTE

_HTML = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>{title}</title>
<style>body{{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:78rem;padding:0 1rem;color:#22262b}}
table{{border-collapse:collapse;width:100%;margin:1rem 0}} th,td{{text-align:left;padding:.3rem .6rem;
border-bottom:1px solid #d8dce0;vertical-align:top}} td.number{{white-space:nowrap}} tr.away td{{background:#fbe9e3}}
small{{color:#5b6168}} img{{max-width:100%}}</style></head>
<body><h1>B compared with A</h1>
<table><tr><th></th><th>signal</th><th>radar</th><th>frames</th><th>antennas</th><th>range</th><th>from</th></tr>
{sides}</table>
<p>Common ranges {near:.2f} to {far:.2f} m. Decibels: {reference}.{chamfer}</p>
<img src="data:image/png;base64,{picture}" alt="Maps of A and B on the same axes and decibels, their static clutter
along range, their points from above, and effect sizes of the features">
<h2>What gives B away</h2>
<p>Effect size: difference of the medians over the spread of the frames and the tolerance of the feature, with the
95 % interval of a bootstrap. Coloured: the whole interval lies beyond 1. AUC: area under the ROC
curve of this feature alone, over frames; 50 % where A and B are alike.</p>
<table><tr><th>feature</th><th>effect size</th><th>A</th><th>B</th><th>AUC</th><th>distance</th></tr>
{rows}</table>
<h2>What one side or both do not show</h2>
<table><tr><th>feature</th><th>A</th><th>B</th></tr>{hidden}</table>
<h2>Maps</h2><ul>{maps}</ul><h2>Notes</h2><ul>{notes}</ul></body></html>
"""


def check_comparison_folder(out: Path, *, overwrite: bool, inputs: Iterable[Path] = ()) -> list[Path]:
    """The files that a comparison writes. Raises InputError where one exists, cannot be written, or is an input's."""
    paths = [out / name for name in (PICTURE, NUMBERS, PAGE)]
    for path in paths:
        check_output_file(path, overwrite=overwrite, inputs=inputs)
    return paths


def write_comparison(comparison: "Comparison", out: Path, *, overwrite: bool) -> list[Path]:
    """Writes the three files, all or none. Raises InputError where one exists or cannot be written."""
    paths = check_comparison_folder(out, overwrite=overwrite)
    with atomic_files(*paths) as (picture, numbers, page):
        draw_comparison(comparison, picture)
        values = json.dumps(comparison.to_values(), indent=2, allow_nan=False, ensure_ascii=False)
        numbers.write_text(f"{values}\n", encoding="utf-8")
        page.write_text(html_page(comparison, read_bytes(picture, max_bytes=LARGEST_PICTURE)), encoding="utf-8")
    return paths


def html_page(comparison: "Comparison", picture: bytes) -> str:
    """The page as text, with the PNG inside."""
    hidden = [one for one in comparison.features if one.difference is None]
    chamfer = comparison.chamfer_m
    return _HTML.format(
        title=escape(f"{comparison.sides[1].name} against {comparison.sides[0].name}"),
        sides="".join(_side(letter, side) for letter, side in zip("AB", comparison.sides, strict=True)),
        near=comparison.axes.range_m[0], far=comparison.axes.range_m[-1], reference=escape(comparison.axes.reference),
        chamfer="" if chamfer is None else f" Chamfer distance of the point clouds: {chamfer:.2f} m.",
        picture=b64encode(picture).decode(), rows="".join(map(_row, comparison.ranked)),
        hidden="".join(
            f"<tr>{_feature(one)}<td>{_value(one.a, one)}</td><td>{_value(one.b, one)}</td></tr>" for one in hidden
        ),
        maps="".join(
            f"<li>mean difference of the {escape(name)}: {value:.1f} dB</li>"
            for name, value in comparison.map_distance_db.items()
        ),
        notes="".join(f"<li>{escape(note)}</li>" for note in comparison.notes),
    )  # fmt: skip


def _side(letter: str, side: "SideFacts") -> str:
    cells = (
        letter, side.name, side.radar, side.frames, side.antennas,
        f"{side.range_m[0]:.2f} to {side.range_m[1]:.2f} m", "raw samples" if side.has_samples else "cube",
    )  # fmt: skip
    return "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>\n"


def _row(one: "FeatureComparison") -> str:
    found = one.difference
    assert found is not None
    span = found.effect_interval_95
    effect = f"{found.effect_size:+.1f}" + ("" if span is None else f" ({span[0]:+.1f} to {span[1]:+.1f})")
    unit = escape(one.feature.unit)
    cells = (
        effect,
        _value(one.a, one),
        _value(one.b, one),
        "" if found.separable is None else f"{100 * found.separable:.0f} %",
        f"{found.wasserstein:.3g} {unit}",
    )
    mark = ' class="away"' if one.gives_away else ""
    return f"<tr{mark}>{_feature(one)}" + "".join(f'<td class="number">{cell}</td>' for cell in cells) + "</tr>\n"


def _feature(one: "FeatureComparison") -> str:
    return f"<td>{escape(one.feature.title)}<br><small>{escape(one.feature.definition)}</small></td>"


def _value(side: "SideValue", one: "FeatureComparison") -> str:
    if side.spread is None:
        return f"cannot be seen here: {escape(side.cannot_see or '')}"
    return f"{escape(side.text(one.feature.unit))}<br><small>of {escape(side.units)}: {side.spread.units}</small>"
