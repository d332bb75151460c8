"""Tables of the zero-shot page."""

import json

from studies.report.zero_shot_table import curve_table, limbs_table, zero_shot_table


def metric(value: float) -> dict:
    return {"value": value, "interval_95": [value - 0.1, value + 0.1], "floor": 0.2, "confusion": [[3, 1], [0, 4]]}


def test_rows_are_recognisers_and_groups(tmp_path):
    (tmp_path / "zero_shot").mkdir()
    for method, values in (("blind", (0.5,)), ("development", (0.9, 0.91, 0.88))):
        rows = [
            {
                "dataset": {"recordings": 7}, "classes": ["a", "b"],
                "metrics": {key: metric(value) for key in ("window", "three_windows", "recording")},
            }
            for value in values
        ]  # fmt: skip
        (tmp_path / "zero_shot" / f"{method}.json").write_text(json.dumps({"rows": rows}))
    halves = [{"metrics": {"window": {"value": value, "chosen_on": 0.92}}} for value in (0.87, 0.89)]
    nested = {"config": {"candidates": 24}, "rows": halves}
    (tmp_path / "zero_shot" / "nested.json").write_text(json.dumps(nested))
    table = zero_shot_table(tmp_path)
    assert "out of 24: 0.920 on the first half, which chose; 0.870 on the other" in table
    assert "| blind | 7 | 0.500 (0.400 to 0.600)" in table
    assert "| *second half* | 7 | 0.880" in table
    assert "| a | 3 | 1 |" in table


def test_the_curve_has_both_ways_side_by_side(tmp_path):
    (tmp_path / "zero_shot").mkdir()
    rows = [
        {
            "real_recordings_each": each,
            "generated": generated,
            "metrics": {"window": {"value": value, "lowest": 0.1, "highest": 1.0}},
        }
        for each, generated, value in ((0, True, 0.8), (5, True, 0.9), (5, False, 0.7))
    ]
    (tmp_path / "zero_shot" / "curve.json").write_text(json.dumps({"rows": rows}))
    lines = curve_table(tmp_path).splitlines()
    assert lines[2].startswith("| 0 | 0.800")
    assert "chance" in lines[2]
    assert lines[3].startswith("| 5 | 0.900")
    assert "0.700" in lines[3]


def test_limbs_have_a_column_a_third(tmp_path):
    (tmp_path / "zero_shot").mkdir()
    rows = [
        {"limb": limb, "from_db": at, "to_db": at + 4.0, "metrics": {"window": {"value": 0.8 + at / 100}}}
        for limb in ("arms_db", "legs_db")
        for at in (-8.0, -4.0, 0.0)
    ]
    (tmp_path / "zero_shot" / "limbs.json").write_text(json.dumps({"rows": rows}))
    lines = limbs_table(tmp_path).splitlines()
    assert lines[2] == "| arms | 0.720 (-8.0 to -4.0 dB) | 0.760 (-4.0 to 0.0 dB) | 0.800 (0.0 to 4.0 dB) |"
    assert lines[3].startswith("| legs | ")
