"""The Python of the pages runs as it stands, block after block, in a folder with what `make demo` wrote there.

A page whose commands make something first (a model, recordings) finds a small one of it.
"""

import ast
import importlib
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mmweaver import Weaver
from mmweaver.cli.generate import DEMO_TEXT
from mmweaver.recognition import train_pose
from mmweaver.recognition.recogniser import save_recogniser
from tests.recognition.small_recogniser import small_recogniser
from tests.recognition.test_train_recogniser import TASK
from tests.training.moving_arm import moving_arm

ROOT = Path(__file__).resolve().parents[2]
PAGES = {
    page.relative_to(ROOT).as_posix().removeprefix("docs/"): page
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md")))
}
# Pages whose code is run by a test of their own.
ELSEWHERE = {
    "README.md": "tests/artifact/test_recipes.py",
    "extend.md": "tests/weaver/test_register.py, in a process of its own, for it registers things",
    "start/your_data_set.md": "tests/artifact/test_tutorials.py, after the commands before it",
    "own_room_dataset.md": "tests/architecture/test_own_room_page.py, which makes its labelled set",
}
# Their parts are tested in tests/comparison, tests/motion/motiongpt, and below.
SLOW = {"compare.md", "evidence/motiongpt.md"}
NOT_INSTALLED = {"datasets": "Hugging Face datasets, which nothing here needs"}


def blocks_of(page: Path) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


WITH_CODE = [name for name, page in PAGES.items() if blocks_of(page) and name not in ELSEWHERE]


def recogniser(place: Path, _: pytest.MonkeyPatch) -> None:
    """What `mmweaver recognise train TASK.toml --out model/` leaves."""
    (place / "task.toml").write_text(TASK.format(more=""))
    save_recogniser(place / "model", small_recogniser(place / "task.toml"))


def pose_network(place: Path, patch: pytest.MonkeyPatch) -> None:
    """What `mmweaver train pose TASK.toml --out model/` leaves, after a step of training."""
    from mmweaver.cli.main import main

    patch.setattr(train_pose, "generate_sequences", lambda _, each, *__: [moving_arm(k) for k in range(each)])
    (place / "task.toml").write_text(TASK.format(more="").replace("window_s = 2.0", "window_s = 0.8"))
    words = ["train", "pose", str(place / "task.toml"), "--out", str(place / "model"), "--sequences", "3"]
    assert main([*words, "--steps", "1", "--batch", "2", "--quiet"]) == 0


MADE_BEFORE: dict[str, Callable[[Path, pytest.MonkeyPatch], None]] = {
    "recognise.md": recogniser,
    "pose.md": pose_network,
}


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder demo/ without its pictures."""
    folder = tmp_path_factory.mktemp("pages") / "demo"
    weaver = Weaver()
    weaver.generate(weaver.sample_room(), DEMO_TEXT).save(folder, pictures=False)
    return folder


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in WITH_CODE]
)
def test_the_blocks_of_a_page_run(name: str, demo: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "demo").symlink_to(demo)
    if name in MADE_BEFORE:
        MADE_BEFORE[name](tmp_path, monkeypatch)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for block in blocks_of(PAGES[name]):
        exec(compile(block, name, "exec"), names)


def test_what_the_blocks_import_is_there():
    for name, page in PAGES.items():
        for line in ast.walk(ast.parse("\n".join(blocks_of(page)))):
            if isinstance(line, ast.ImportFrom) and line.module not in NOT_INSTALLED:
                assert line.module is not None
                module = importlib.import_module(line.module)
                for one in line.names:
                    assert hasattr(module, one.name), f"{name}: {line.module} has no {one.name}"


def test_all_python_of_the_pages_is_in_blocks_that_are_run():
    assert sum(len(blocks_of(page)) for page in PAGES.values()) >= 21
    for name, page in PAGES.items():
        assert not re.search(r"^ {4}(from \w+ )?import \w", page.read_text(encoding="utf-8"), flags=re.MULTILINE), name
    for name in (*ELSEWHERE, *MADE_BEFORE, *SLOW):
        assert blocks_of(PAGES[name]), name
