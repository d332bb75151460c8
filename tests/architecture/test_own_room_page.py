"""docs/own_room_dataset.md as a student would follow it: photo, .cfg, activities, DataLoader; by night to the end.

Training on such a set is tested fast in tests/cli/test_train_recipes.py.
"""

import json
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from mmweaver.cli.main import main
from tests.io.test_ti_cfg import BEST_RANGE

pytest.importorskip("zarr")
ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "own_room_dataset.md").read_text(encoding="utf-8")
TEN = """[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
clapping = ["a person claps"]
walking = ["a person walks around"]
squatting = ["a person squats"]
boxing = ["a person boxes"]
jumping = ["a person jumps"]
jumping_jacks = ["a person does jumping jacks"]
bowing = ["a person bows"]
kicking = ["a person kicks"]
standing = ["a person stands still"]
"""


def block(language: str, number: int = 0) -> str:
    """One of the page's blocks of a language, the first without a number."""
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)[number]


def command(start: str) -> list[str]:
    """The words of the page's first command that begins so, without its comment."""
    line = next(line.strip() for line in PAGE.splitlines() if line.startswith(f"    mmweaver {start}"))
    return shlex.split(line, comments=True)[1:]


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the student's room and radar."""
    sample = ROOT / "src" / "mmweaver" / "sample"
    (tmp_path / "living_room").mkdir()
    Image.open(sample / "rgb.webp").save(tmp_path / "living_room" / "rgb.png")
    for name in ("depth.png", "camera.json"):
        shutil.copyfile(sample / name, tmp_path / "living_room" / name)
    (tmp_path / "profile.cfg").write_text(BEST_RANGE)
    (tmp_path / "activities.toml").write_text(block("toml"))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def make_set(each: int, *more: str) -> None:
    words = command("dataset set/ --room")
    words[words.index("--per-class") + 1] = str(each)
    assert main([*words, "--quiet", *more]) == 0


def run_python(language_block: str) -> dict[str, Any]:
    names: dict[str, Any] = {}
    exec(compile(language_block, "own_room_dataset.md", "exec"), names)
    return names


def test_the_page_gives_a_loader_and_no_leak(place: Path):
    make_set(3, "--seconds", "1", "--subjects", "3", "--range", "0.5,3.5")
    assert json.loads((place / "set" / "leaks.json").read_text())["verdict"] == "leaks: none found"
    names = run_python(block("python"))
    batch = names["batch"]
    assert batch["micro_doppler"].ndim == 3
    assert batch["micro_doppler"].shape[2] == 16  # the loops of this .cfg
    assert set(batch["label"].tolist()) <= {0, 1, 2}
    assert len(names["train"].label_names) == 3
    pytest.importorskip("xarray")
    assert run_python(block("python", 1))["near"].shape[0] == 3


@pytest.mark.slow  # the test above makes the set by the same commands; test_train_recipes.py trains on one
def test_ten_activities_become_a_trained_network(place: Path):
    (place / "activities.toml").write_text(TEN)
    make_set(30)
    report = json.loads((place / "set" / "leaks.json").read_text())
    assert report["verdict"] == "leaks: none found"
    assert run_python(block("python"))["accuracy"] > 0.6  # 0.82 was measured; chance is 0.1
