"""Layouts of tables: what a declaration says, and how it becomes Markdown.

A declaration is small data: which results, which rows, which columns, and a template for each cell (`cell_formats`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from studies.report.cell_formats import cell, markdown
from studies.schema import read_record

Context = dict[str, Any]  # a result row with its `record`, and what a layout adds
Columns = tuple[tuple[str, str], ...]  # (head, template)


def records_of(results: Path, *sources: str) -> list[dict[str, Any]]:
    """Results by glob pattern below the folder of results, by name within a pattern. Raises InputError for none."""
    found = []
    for source in sources:
        paths = sorted(path for path in results.glob(f"{source}.json") if "judgements" not in path.name)
        if not paths:
            raise InputError(f"{results / source}.json is missing; run its study first: python -m studies list")
        found += [read_record(path) for path in paths]
    return found


def contexts_of(results: Path, sources: tuple[str, ...]) -> list[Context]:
    """Every row of some results, each with its record."""
    return [{**row, "record": record} for record in records_of(results, *sources) for row in record["rows"]]


@dataclass(frozen=True, kw_only=True)
class RowTable:
    """A line for each row of the results.

    Attributes:
        sources: globs of results.
        columns: head and template of each column.
        labels: {value of `key`: text}; with it lines are those named, in this order, and `{label}` is the text.
        key: path of the field that names a row.
        before: lines of comparisons before the rows of each data set, as (label, path in a metric, such as
            "baseline.zeros"); templates then apply to that score in place of the value.
    """

    sources: tuple[str, ...]
    columns: Columns
    labels: Mapping[str, str] = field(default_factory=dict)
    key: str = "method"
    before: tuple[tuple[str, str], ...] = ()
    missing: str = "-"

    def render(self, results: Path) -> str:
        lines = [[cell(template, one, self.missing) for _, template in self.columns] for one in self._lines(results)]
        return markdown([head for head, _ in self.columns], lines)

    def _lines(self, results: Path) -> Iterator[Context]:
        rows = contexts_of(results, self.sources)
        if self.before:
            yield from self._with_comparisons(rows)
        elif self.labels:
            by_key = {cell(f"{{{self.key}}}", row): row for row in rows}
            yield from ({**by_key[name], "label": text} for name, text in self.labels.items() if name in by_key)
        else:
            yield from rows

    def _with_comparisons(self, rows: list[Context]) -> Iterator[Context]:
        for name in dict.fromkeys(row["dataset"]["name"] for row in rows):
            own = [row for row in rows if row["dataset"]["name"] == name]
            for label, path in self.before:
                compared = _compared(own[0], path)
                if compared:
                    yield {"dataset": own[0]["dataset"], "label": label, "metrics": compared}
            yield from ({**row, "label": row["record"]["method"]} for row in own)


def _compared(row: Context, path: str) -> dict[str, Any]:
    """{metric: score of another on the same data}; empty where it was not measured."""
    kind, _, name = path.partition(".")
    every = {metric: (one.get(kind) or {}).get(name, ...) for metric, one in row["metrics"].items()}
    return {} if ... in every.values() and set(every.values()) == {...} else {
        metric: {"value": value} for metric, value in every.items() if value is not ...
    }  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class MetricTable:
    """A line for each (metric, label) of each row; templates see the metric as `metric`, the row's fields, `label`."""

    sources: tuple[str, ...]
    columns: Columns
    lines: tuple[tuple[str, str], ...]
    missing: str = ""

    def render(self, results: Path) -> str:
        lines = []
        for row in contexts_of(results, self.sources):
            for name, label in self.lines:
                context = {**row, "metric": row["metrics"][name], "label": label}
                lines.append([cell(template, context, self.missing) for _, template in self.columns])
        return markdown([head for head, _ in self.columns], lines)


@dataclass(frozen=True, kw_only=True)
class MatrixTable:
    """Metrics down, results across.

    Attributes:
        lines: (metric, label, format).
        head: template of the head of each result row's column; with `prefixes` there is one row, and a column for each
            (head, prefix of the metric's name).
    """

    sources: tuple[str, ...]
    corner: str
    lines: tuple[tuple[str, str, str], ...]
    head: str = "measured"
    prefixes: tuple[tuple[str, str], ...] = ()
    missing: str = "-"

    def render(self, results: Path) -> str:
        rows = contexts_of(results, self.sources)
        pairs = [(cell(self.head, row), "", row) for row in rows]
        if self.prefixes:
            pairs = [(head, prefix, rows[0]) for head, prefix in self.prefixes]
        lines = []
        for name, label, template in self.lines:
            metrics = [row["metrics"].get(prefix + name) for _, prefix, row in pairs]
            cells = [self.missing if one is None else cell(template, {"metric": one}) for one in metrics]
            lines.append([label, *cells])
        return markdown([self.corner, *(head for head, _, _ in pairs)], lines)


@dataclass(frozen=True, kw_only=True)
class PivotTable:
    """One field of the rows down, another across.

    Attributes:
        rows: head and template of the leading columns; rows with the same leading cells share a line.
        across: template of the field that chooses the column.
        cells: {value of `across`: ((head, template), ...)}; None takes every value, with `cell_template`.
        order: leading cells in the order of the lines (default: as they occur).
    """

    sources: tuple[str, ...]
    rows: Columns
    across: str
    cells: Mapping[str, Columns] | None = None
    cell_template: str = ""
    head_template: str = "{across}"
    order: tuple[tuple[str, ...], ...] = ()
    labels: Mapping[str, str] = field(default_factory=dict)
    sorts: bool = False
    missing: str = "-"

    def render(self, results: Path) -> str:
        contexts = contexts_of(results, self.sources)
        for one in contexts:
            one["across"] = one["record"]["method"] if self.across == "{record.method}" else cell(self.across, one)
            one["label"] = self.labels.get(cell("{record.method}", one), "")
        cells = self.cells or {
            name: ((cell(self.head_template, first), self.cell_template),) for name, first in self._columns(contexts)
        }
        found: dict[tuple[str, ...], dict[str, Context]] = {}
        for one in contexts:
            found.setdefault(tuple(cell(template, one) for _, template in self.rows), {})[one["across"]] = one
        lines = []
        for leading in self.order or tuple(found):
            own = found.get(leading, {})
            shown = [
                cell(template, own[name], self.missing) if name in own else self.missing
                for name, columns in cells.items()
                for _, template in columns
            ]
            lines.append([*leading, *shown])
        return markdown([*(head for head, _ in self.rows), *(head for one in cells.values() for head, _ in one)], lines)

    def _columns(self, contexts: list[Context]) -> list[tuple[str, Context]]:
        first = {one["across"]: one for one in reversed(contexts)}
        names = list(dict.fromkeys(one["across"] for one in contexts))
        return [(name, first[name]) for name in (sorted(names, key=float) if self.sorts else names)]
