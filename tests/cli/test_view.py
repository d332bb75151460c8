"""mmweaver view: a result folder as one page, with its room where its files are still there."""

import json
import shutil
from pathlib import Path

import pytest

from mmweaver.cli.main import main

SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("view")
    for file in ("rgb.webp", "depth.png", "camera.json"):
        shutil.copy(SAMPLE / file, folder / file)
    arguments = ["--rgb", "rgb.webp", "--depth", "depth.png", "--camera", "camera.json"]
    arguments = [str(folder / word) if (folder / word).is_file() else word for word in arguments]
    assert main(["generate", *arguments, "--text", "a person waves", "--no-pictures", "--quiet", "--out",
                 str(folder / "out")]) == 0  # fmt: skip
    return folder


def viewed(folder: Path, page: Path) -> str:
    assert main(["view", str(folder), "-o", str(page), "--no-browser"]) == 0
    return page.read_text(encoding="utf-8")


def test_the_page_holds_the_room_of_unchanged_files(made: Path, tmp_path: Path):
    assert 'id="room"' in viewed(made / "out", tmp_path / "with.html")
    meta = json.loads((made / "out" / "meta.json").read_text())
    meta["inputs"]["depth"]["sha256"] = "0" * 64
    shutil.copytree(made / "out", tmp_path / "changed")
    (tmp_path / "changed" / "meta.json").write_text(json.dumps(meta))
    page = viewed(tmp_path / "changed", tmp_path / "without.html")
    assert 'id="room"' not in page
    assert 'id="sequence"' in page


def test_what_is_no_result_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["view", str(tmp_path), "--no-browser"]) == 2
    assert "holds no radar.npz" in capsys.readouterr().err
    assert main(["view", str(tmp_path / "absent"), "--no-browser"]) == 2
    assert "absent does not exist" in capsys.readouterr().err
