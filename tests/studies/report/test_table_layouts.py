"""Layouts of declared tables, of small results."""

import json
from pathlib import Path
from typing import Any

import pytest

from mmweaver.core.errors import InputError
from studies.report.table_layouts import MatrixTable, MetricTable, PivotTable, RowTable


def put(folder: Path, name: str, rows: list[dict[str, Any]]) -> None:
    file = folder / f"{name}.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"method": file.name.removesuffix(".json"), "rows": rows}))


def metric(value: float, **more: Any) -> dict[str, Any]:
    return {"value": value, "unit": "m", "interval_95": [value - 1, value + 1], **more}


def test_rows_in_declared_order(tmp_path: Path):
    put(tmp_path, "one/two", [{"method": name, "metrics": {"x_m": metric(at)}} for at, name in enumerate("abc")])
    table = RowTable(
        sources=("one/*",),
        labels={"c": "third", "a": "first"},
        columns=(("who", "{label}"), ("x", "{metrics.x_m:.0f}")),
    )
    assert table.render(tmp_path).splitlines() == ["| who | x |", "| --- | --- |", "| third | 2 |", "| first | 0 |"]


def test_comparisons_stand_before_the_rows_of_their_data_set(tmp_path: Path):
    scores = {"x_m": metric(1.0, baseline={"zeros": 5.0}), "y_m": metric(2.0, baseline={"zeros": 6.0})}
    put(tmp_path, "one/own", [{"dataset": {"name": "walk"}, "metrics": scores}])
    table = RowTable(
        sources=("one/*",), before=(("*zeros*", "baseline.zeros"), ("*other*", "oracle.realization")),
        columns=(("of", "{dataset.name}"), ("who", "{label}"), ("x", "{metrics.x_m:.0f}"), ("y", "{metrics.y_m:.0f}")),
    )  # fmt: skip
    assert table.render(tmp_path).splitlines()[2:] == ["| walk | *zeros* | 5 | 6 |", "| walk | own | 1 | 2 |"]


def test_metrics_down(tmp_path: Path):
    put(tmp_path, "one/two", [{"n": 3, "metrics": {"x_m": metric(1.0), "y_m": metric(2.0, share=0.5)}}])
    table = MetricTable(
        sources=("one/two",), columns=(("figure", "{label}"), ("value", "{metric:.1f}"), ("n", "{n}")),
        lines=(("y_m", "y"), ("x_m", "x")),
    )  # fmt: skip
    assert table.render(tmp_path).splitlines()[2:] == ["| y | 2.0 | 3 |", "| x | 1.0 | 3 |"]


def test_what_was_not_run_is_left_empty(tmp_path: Path):
    put(tmp_path, "one/two", [{"metrics": {"signals_kb": metric(1843.2), "signals_s": metric(0.88)}}])
    table = MatrixTable(
        sources=("one/two",), corner="what", missing="", prefixes=(("with signals", "signals_"), ("geometry", "geo_")),
        lines=(("kb", "on disk", "{metric:.0f} kB"), ("s", "a room", "{metric:.1f} s")),
    )  # fmt: skip
    assert table.render(tmp_path).splitlines() == [
        "| what | with signals | geometry |",
        "| --- | --- | --- |",
        "| on disk | 1843 kB |  |",
        "| a room | 0.9 s |  |",
    ]


def test_a_pivot_has_a_column_for_each_value(tmp_path: Path):
    rows = [{"limb": limb, "size": size, "metrics": {"x_m": metric(size)}} for limb in "ab" for size in (10, 9)]
    put(tmp_path, "one/two", rows[:3])
    table = PivotTable(
        sources=("one/two",), rows=(("limb", "{limb}"),), across="{size}", sorts=True, head_template="{size} B",
        cell_template="{metrics.x_m:.1f}", order=(("b",), ("a",)),
    )  # fmt: skip
    assert table.render(tmp_path).splitlines() == [
        "| limb | 9 B | 10 B |", "| --- | --- | --- |", "| b | - | 10.0 |", "| a | 9.0 | 10.0 |",
    ]  # fmt: skip


def test_without_results_it_says_so(tmp_path: Path):
    with pytest.raises(InputError, match=r"two\.json"):
        RowTable(sources=("one/two",), columns=()).render(tmp_path)
