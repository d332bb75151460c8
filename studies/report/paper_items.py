"""The table of the paper's items: each with a result of ours, or the reason why there is none (`paper_items.toml`)."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from studies.report.cell_formats import cell, markdown
from studies.report.table_layouts import contexts_of

HEADS = ["the paper's item", "paper", "ours", "baseline", "oracle", "what it says", "made by"]
UNFILLED = "?"


@dataclass(frozen=True, kw_only=True)
class PaperItem:
    """One figure or number of the paper.

    Attributes:
        name: for `--table`.
        item: what it is, and where in the paper.
        paper: its number there.
        source: the result that stands for it here; none where `missing` says why.
        where: {path of a field: its value} of the row.
        ours, baseline, oracle: templates of the row (`cell_formats`); of that of `baseline_source` where it is given.
        reading: what a reader may conclude.
        study: the study that measures it, with options.
        missing: why no result stands for it; `ours`, `baseline` and `oracle` then say what there is instead.
    """

    name: str
    item: str
    paper: str
    source: str = ""
    where: Mapping[str, str] = field(default_factory=dict)
    ours: str = ""
    baseline: str = "-"
    baseline_source: str = ""
    oracle: str = "-"
    reading: str = ""
    study: str = ""
    missing: str = ""

    @property
    def command(self) -> str:
        """What measures it."""
        return f"python -m studies run {self.study}" if self.study else ""

    def cells(self, results: Path) -> list[str]:
        """A line of the table. Raises InputError where the result lacks the row or a field of it."""
        command = f"`{self.command}`" if self.command else "-"
        if self.missing:
            return [self.item, self.paper, self.ours or "none", self.baseline, self.oracle, self.missing, command]
        row = self._row(results, self.source)
        other = self._row(results, self.baseline_source) if self.baseline_source else row
        templates = ((self.ours, row), (self.baseline, other), (self.oracle, row))
        found = [cell(template, context, UNFILLED) for template, context in templates]
        if UNFILLED in found:
            raise InputError(
                f"{self.source}: the row of {self.name!r} lacks a field; see studies/report/paper_items.toml"
            )
        return [self.item, self.paper, *found, self.reading, command]

    def _row(self, results: Path, source: str) -> dict[str, Any]:
        for row in contexts_of(results, (source,)):
            if all(cell(f"{{{path}}}", row) == value for path, value in self.where.items()):
                return row
        raise InputError(f"{source} has no row with {dict(self.where)}; see studies/report/paper_items.toml")


def paper_items() -> list[PaperItem]:
    """All items in the paper's order."""
    text = Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
    return [PaperItem(**values) for values in tomllib.loads(text)["item"]]


def paper_table(results: Path) -> str:
    """All items, a line each."""
    return markdown(HEADS, [item.cells(results) for item in paper_items()])
