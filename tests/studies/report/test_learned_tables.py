"""Tables of the network's use, made of small results."""

import json
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.report.learned_tables import (
    ELSEWHERE,
    SHORT,
    ablation_table,
    activity_table,
    elsewhere_table,
    gain_table,
    paper_few_table,
    paper_table,
    photographed_table,
    real_or_simulated_table,
    short_table,
    small_gain_table,
)


def _metric(value: float) -> dict:
    return {"value": value, "low": value - 0.1, "high": value + 0.1, "floor": {"chance": 1 / 12}}


def _put(folder: Path, name: str, rows: list[dict]) -> None:
    file = folder / name
    file.parent.mkdir(parents=True)
    file.write_text(json.dumps({"rows": rows}))


def test_they_show_values_with_intervals(tmp_path: Path):
    accuracy = {"accuracy": _metric(0.5)}
    _put(tmp_path, "activity_accuracy/activity.json",
         [{"split": "test_room", "n": 4, "num_rooms": 2, "metrics": accuracy}])  # fmt: skip
    gain = {**accuracy, "gain": _metric(0.05), "log_loss_gain": _metric(0.2)}
    gains = [{"method": name, "metrics": gain} for name in ("other_rooms", "weaver")]
    _put(tmp_path, "activity_gain/test_room.json", gains)
    _put(tmp_path, "real_or_generated/test_room.json", [{"method": "twin", "metrics": accuracy}])
    names = ("cssim", "psnr_db", "nmse_db", "nmse_active_db", "nmse_moving_db", "rd_ssim", "ra_ssim")
    _put(tmp_path, "weaver_paper/test_room.json",
         [{"method": "zeros", "metrics": {name: _metric(0.25) for name in names}}])  # fmt: skip
    assert "| kinds of rooms | 4 | 2 | 50.0 % (40.0 to 60.0) | 8 % |" in activity_table(tmp_path)
    (tmp_path / "activity_gain/recordings_60.json").write_text(json.dumps({"rows": gains[:1]}))
    assert len(small_gain_table(tmp_path).splitlines()) == 3
    shown = gain_table(tmp_path).splitlines()
    assert shown[2] == "| other_rooms | 50.0 % (40.0 to 60.0) |  |  |"
    assert shown[3].endswith("| +5.0 (-5.0 to +15.0) | +0.200 (+0.100 to +0.300) |")
    assert "| twin | 50.0 % (40.0 to 60.0) | 50 % |" in real_or_simulated_table(tmp_path)
    both = {"ra_ssim": _metric(0.5), "ra_difference_db": _metric(6.0)}
    _put(tmp_path, "photographed_room/echoes.json", [{"method": "twin", "metrics": both}])
    assert photographed_table(tmp_path).endswith("| twin | 0.50 (0.40 to 0.60) | 6.00 |")
    assert "| zeros | 0.250 | 0.2 |" in paper_table(tmp_path)
    for name in ("few_train", "few_test_room"):
        (tmp_path / "weaver_paper" / f"{name}.json").write_text(
            (tmp_path / "weaver_paper" / "test_room.json").read_text()
        )
    few = paper_few_table(tmp_path).splitlines()
    assert [line.split(" | ")[0] for line in few[2:]] == ["| zeros, what it trained on", "| zeros, unseen kinds"]


def test_the_short_table_has_its_rows_in_its_own_order(tmp_path: Path):
    metrics = {"ra_ssim": _metric(0.25), "rd_ssim": _metric(0.5)}
    _put(tmp_path, "weaver/test_room.json", [{"method": name, "metrics": metrics} for name in reversed(SHORT)])
    lines = short_table(tmp_path).splitlines()
    assert lines[2] == "| all zeros | 0.25 (0.15 to 0.35) | 0.50 (0.40 to 0.60) |"
    assert [line.split(" | ")[0][2:] for line in lines[2:]] == list(SHORT.values())


def test_elsewhere_has_a_line_for_each_radar(tmp_path: Path):
    rows = [
        {"method": name, "num_rooms": 12, "metrics": {"ra_ssim": _metric(0.25), "rd_ssim": _metric(0.5)}}
        for name in ("zeros", "generic_room_physics", "weaver", "physics_in_photographed_room", "twin")
    ]
    folder = tmp_path / "weaver_elsewhere"
    folder.mkdir()
    for name in ELSEWHERE:
        (folder / f"{name}.json").write_text(json.dumps({"rows": rows}))
    lines = elsewhere_table(tmp_path).splitlines()
    assert len(lines) == 2 + len(ELSEWHERE)
    assert lines[2] == "| preset `hupr` | 12 |" + " 0.25 / 0.50 |" * 5


def test_without_results_they_say_so(tmp_path: Path):
    with pytest.raises(InputError, match="run the experiment"):
        gain_table(tmp_path)


def test_an_ablation_shows_differences_of_pairs(tmp_path: Path):
    easy_and_hard = [0.2, 0.8]
    for name, each in (("whole", easy_and_hard), ("no_ghosts", [0.1, 0.7]), ("twin", [0.9, 0.9])):
        metrics = {"ra_ssim": {"value": sum(each) / 2, "each": each}}
        row = {"method": name.replace("_", " "), "metrics": metrics}
        file = tmp_path / "weaver_ablation" / f"{name}.json"
        file.parent.mkdir(exist_ok=True)
        file.write_text(json.dumps({"rows": [row]}))
    lines = ablation_table(tmp_path).splitlines()
    assert [line.split("|")[1].strip() for line in lines[2:]] == ["whole", "no ghosts", "twin"]
    assert lines[2].startswith("| whole | 0.50 |")
    assert "0.40 (-0.100; -0.100 to -0.100)" in lines[3]  # rooms differ, their differences do not
