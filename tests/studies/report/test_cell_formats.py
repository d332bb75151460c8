"""Templates of cells."""

import pytest

from studies.report.cell_formats import cell, markdown

METRIC = {"value": 0.4012, "interval_95": [0.35, 0.45], "of": 200, "baseline": {"zeros": -0.001}}


@pytest.mark.parametrize(
    ("template", "text"),
    [
        ("{m:fixed.2}", "0.40"),
        ("{m:interval.2}", "0.40 (0.35 to 0.45)"),
        ("{m:number_interval}", "0.40 (0.35 to 0.45)"),
        ("{m.baseline.zeros:number}", "0.00"),
        ("{m:percent.0}", "40 %"),
        ("{m:percent_interval.1}", "40.1 % (35.0 to 45.0)"),
        ("{m:signed_interval.3}", "+0.401 (+0.350 to +0.450)"),
        ("{m:points_interval.1}", "+40.1 (+35.0 to +45.0)"),
        ("{m:share.1}", "40.1 % of 200"),
        ("{m:share_interval.1}", "40.1 % of 200 (35.0 to 45.0)"),
        ("{m:edges_percent.1}", "35.0 to 45.0 %"),
        ("{m:.3f} of {n:,}", "0.401 of 1,000"),
        ("{absent.x:fixed.2}", "-"),
        ("{none:fixed.2} / {none:.1f}", "- / -"),
    ],
)
def test_formats(template: str, text: str):
    assert cell(template, {"m": METRIC, "n": 1000, "none": {"value": None}}) == text


def test_a_difference_from_itself_is_no_number():
    assert cell("{m:signed_interval.1}", {"m": {"value": 0.0, "interval_95": [0.0, 0.0]}}) == ""


def test_markdown():
    assert markdown(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |"
