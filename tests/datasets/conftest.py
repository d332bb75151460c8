"""One small labelled set, and one short result with samples, each made once."""

import os
from pathlib import Path

import pytest
from filelock import FileLock

from mmweaver.datasets.build_set import SetBuilder, SetOptions, read_activities
from mmweaver.io.stored_result import StoredResult, read_result
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


FRAMES = 4  # two in a second


@pytest.fixture(scope="session")
def result_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("export") / "result"
    weaver = Weaver(radar="hupr")
    generation = weaver.generate(weaver.sample_room(), "a person waves", frames=FRAMES, fps=2.0, keep_adc=True)
    generation.save(folder, adc_data_bin=True, pictures=False)
    return folder


@pytest.fixture(scope="session")
def result(result_folder: Path) -> StoredResult:
    return read_result(result_folder)
