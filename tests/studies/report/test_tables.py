"""Declared tables, of the results of the project."""

from pathlib import Path

import pytest

from studies.report.tables import TABLES

RESULTS = Path(__file__).resolve().parents[3] / "results"


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ("real_rooms", "| redwood_chair_corner | 297 | 90 % | 35 % |"),
        ("mars", "| baseline centroid | "),
        ("kitml", "| understood, of all | 6,082 |"),
        ("labelled_radhar", "| 0 |  | 0.882 (0.882 to 0.882) |  |"),
        ("super_resolution", "| own_cells | 1 | "),
        ("field_fidelity", "| walking | *other realization* |"),
    ],
)
def test_lines_of_tables(table: str, line: str):
    assert line in TABLES[table](RESULTS)


@pytest.mark.parametrize("table", list(TABLES))
def test_every_table_is_whole_markdown(table: str):
    """As many cells in every line, and no template that was not filled."""
    text = TABLES[table](RESULTS)
    assert "{" not in text
    first = text.split("\n\n")[0].splitlines()
    assert len({line.count("|") for line in first}) == 1
    assert len(first) > 2


def test_oracles_and_baselines_come_first_in_mars():
    lines = TABLES["mars"](RESULTS).splitlines()
    assert lines[2].startswith("| baseline centroid | ")
    assert lines[7].startswith("| simulator | ")
