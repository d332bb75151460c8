"""What people and machines are told at the end."""

import json
import re

import pytest

from mmweaver.cli.option_groups import Printed
from mmweaver.cli.summary import machine_summary, summary_lines
from mmweaver.core.assumptions import UsualAssumption

META = {
    "files": {"radar.npz": "the cube", "preview.png": "pictures"},
    "assumed": ["a stool", "D455 field of view"],
    "seconds": {"simulate": 0.5, "draw": 1.0},
    "method": "weaver",
    "frames": 20,
    "radar": {"name": "awr1843"},
    "resolution": {
        "range_m": 0.044, "radial_velocity_mps": 0.274, "range_window_m": [0.7, 3.48], "max_velocity_mps": 4.39,
    },
    "person": {"height_m": 1.75, "starts_at_m": [0.3, 2.9], "ends_at_m": [-0.08, 1.37], "path_length_m": 1.57,
               "shown": "walking towards the radar, then waving with one hand repeatedly"},
}  # fmt: skip


def test_people_hear_where_what_and_on_which_assumptions():
    text = "\n".join(summary_lines("walk", META))
    files = ("walk", "1.5 s", "radar.npz")
    for word in (
        *files,
        "the network",
        "4.40 cm",
        "1.75 m",
        "(-0.08, 1.37)",
        "assumed: a stool",
        "D455",
        "motion:  walking towards the radar, then waving with one hand repeatedly",
    ):
        assert word in text


def test_machines_read_json_people_read_lines_and_quiet_is_quiet(capsys: pytest.CaptureFixture[str]):
    printed = []
    for how in ({"json": True}, {}, {"quiet": True}):
        assert Printed(**how).report(machine_summary("walk", META), "two", "lines") == 0
        printed.append(capsys.readouterr().out)
    summary = json.loads(printed[0])
    assert summary["files"]["radar.npz"] == "walk/radar.npz"
    assert {name: summary[name] for name in ("assumed", "seconds", "method")} == {
        name: META[name] for name in ("assumed", "seconds", "method")
    }
    assert printed[1:] == ["two\nlines\n", ""]


def test_usual_assumptions_are_for_verbose():
    meta = META | {"assumed": ["a stool", UsualAssumption("the radar is level")]}
    short, long = ("\n".join(summary_lines("walk", meta, verbose=verbose)) for verbose in (False, True))
    assert "assumed: a stool" in short
    assert "level" not in short
    assert re.search(r"1 more .*--verbose", short)
    assert "assumed: the radar is level" in long
    assert "--verbose" not in long
