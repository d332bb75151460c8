"""One small labelled set, made once."""

import os
from pathlib import Path

import pytest
from filelock import FileLock

from mmweaver.activity_sets.build_set import SetBuilder, SetOptions, read_activities
from mmweaver.weaver.front_door import Weaver

ACTIVITIES = """[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
walking = ["a person walks around"]
squatting = "a person squats"
"""
OPTIONS = SetOptions(each=6, subjects=3, seconds=2.0, places=4)


def builder(out: Path, options: SetOptions = OPTIONS, text: str = ACTIVITIES) -> SetBuilder:
    file = out.parent / "activities.toml"
    file.write_text(text, encoding="utf-8")
    weaver = Weaver()
    return SetBuilder(
        out, read_activities(file), [weaver.sample_room()], weaver, options, command="mmweaver dataset set",
        activities_text=text,
    )  # fmt: skip


@pytest.fixture(scope="session")
def activity_set(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nobody writes into it."""
    pytest.importorskip("zarr")
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder = shared / "activity_set" / "set"
    folder.parent.mkdir(exist_ok=True)
    with FileLock(f"{folder}.lock"):
        if not (folder / "sequences.zarr").is_dir():
            builder(folder).make()
    return folder
