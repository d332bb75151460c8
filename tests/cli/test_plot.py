"""mmweaver plot: a picture of features, or one line."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.cli.main import main


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plot") / "walk"
    words = ["generate", "--demo", "--text", "a person walks to the left", "--frames", "6", "--out", str(folder)]
    assert main([*words, "--quiet"]) == 0
    return folder


def picture(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_each_feature_adds_a_row_and_each_frame_a_column(walk: Path, tmp_path: Path):
    def drawn(feature: str, frames: str) -> np.ndarray:
        out = tmp_path / f"{feature}-{frames}.png"
        assert main(["plot", str(walk), "--feature", feature, "--frames", frames, "-o", str(out)]) == 0
        return picture(out)

    one, wide, tall = drawn("rd", "0"), drawn("rd", "0,3"), drawn("rd,ra,micro_doppler,drai,points", "0")
    assert wide.shape[1] > 1.5 * one.shape[1]
    assert wide.shape[0] == one.shape[0]
    assert tall.shape[0] > 3 * one.shape[0]
    assert len(np.unique(one.reshape(-1, 3), axis=0)) > 100


def test_without_the_mean_chirp_the_middle_of_the_doppler_axis_is_dark(walk: Path, tmp_path: Path):
    def share_bright(*options: str) -> float:
        out = tmp_path / f"{len(options)}.png"
        assert main(["plot", str(walk), "--feature", "rd", "--frames", "2", "-o", str(out), *options]) == 0
        colour = picture(out)
        return float(((colour[..., 0] > 150) & (colour[..., 2] < 120)).mean())  # orange and yellow

    assert share_bright("--remove-static", "mean_chirp") < 0.8 * share_bright()


@pytest.mark.parametrize(
    "options",
    [["--feature", "sd"], ["--frames", "99"], ["--frames", "a"], ["--frames", "-1"], ["--sequence", "0"],
     ["--out", "features.jpg"], ["--frames", "0,1,2,3,4,5,0,1,2"]],
)  # fmt: skip
def test_mistakes_are_one_line_and_nothing_is_written(
    walk: Path, options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    options = [options[0] + "=" + options[1]]
    assert main(["plot", str(walk), *options]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
