"""The three files of a comparison: all or none, one page without anything from a network, names escaped."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.core.errors import InputError
from mmweaver.evaluation.compare_signals import compare
from mmweaver.evaluation.comparison_page import NUMBERS, PAGE, PICTURE
from mmweaver.signal.cube import radar_cube
from tests.evaluation.made_signals import samples, still


@pytest.fixture(scope="module")
def comparison():
    cubes = [radar_cube(samples([still(1.2), still(2.4, 0.5)], noise=0.05, seed=seed)) for seed in (0, 1)]
    found = compare(*cubes)
    from dataclasses import replace

    return replace(found, sides=(replace(found.sides[0], name="<script>alert(1)</script>"), found.sides[1]))


def test_the_files(comparison, tmp_path: Path):
    written = comparison.save(tmp_path / "out")
    assert [path.name for path in written] == [PICTURE, NUMBERS, PAGE]
    pixels = np.asarray(Image.open(written[0]).convert("RGB"))
    assert pixels.shape[1] == 1600
    assert pixels.std() > 20
    assert json.loads(written[1].read_text())["ranked"]
    page = written[2].read_text()
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "://" not in page  # nothing is loaded from elsewhere
    assert "window is cut" in page
    with pytest.raises(InputError, match="--overwrite"):
        comparison.save(tmp_path / "out")
    comparison.save(tmp_path / "out", overwrite=True)
