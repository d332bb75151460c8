"""One short result with samples, shared by the tests of all formats."""

from pathlib import Path

import pytest

from mmweaver import Weaver
from mmweaver.formats.stored_result import StoredResult, read_result

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
