"""mmweaver generate: the demo, a person's own pictures, and every bad input in one line that leaves nothing behind."""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mmweaver.cli.main import main
from mmweaver.io.npz_files import read_npz, read_radar_npz
from mmweaver.scene.photo_files import sample_photo
from mmweaver.viz.preview import PREVIEWS
from tests.captures import write_camera

WALK = "a person walks towards the radar"


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample room as a person would have it: rgb.png, depth.png in millimetres, camera.json."""
    folder = tmp_path_factory.mktemp("pictures")
    photo, _ = sample_photo()
    Image.fromarray(photo.rgb).save(folder / "rgb.png")
    depth_mm = np.nan_to_num(photo.depth_m * 1000).round().astype(np.uint16)
    Image.fromarray(depth_mm).save(folder / "depth.png")
    np.save(folder / "depth.npy", photo.depth_m.astype(np.float32))
    lens = photo.intrinsics
    (folder / "camera.json").write_text(json.dumps({"fx": lens.fx, "fy": lens.fy, "cx": lens.cx, "cy": lens.cy}))
    return folder


def test_the_demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.chdir(tmp_path)
    assert main(["generate", "--demo"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    for word in ("wrote demo", "preview.png", "assumed: ", "person: ", "4.40 cm"):
        assert word in captured.out
    cube = read_radar_npz(tmp_path / "demo" / "radar.npz").values
    assert cube.shape[1:] == (64, 32, 12)
    assert 20 <= len(cube) <= 60  # as many frames as the walk and the wave take
    assert main(["generate", "--demo"]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert main(["generate", "--demo", "--overwrite", "--frames", "2", "--text", WALK, "--quiet"]) == 0
    assert capsys.readouterr().out == ""


def test_a_demo_too_short_for_its_sentence_says_how_long_it_takes(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    argv = ["generate", "--demo", "--frames", "2", "--text", "a person bows, then waves"]
    assert main([*argv, "--out", str(tmp_path / "out")]) == 2
    assert re.search(r"0\.7 s.*--seconds.*--frames", capsys.readouterr().err)
    assert not (tmp_path / "out").exists()


def test_the_photo_of_a_capture_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    photo, _ = sample_photo()
    write_camera(tmp_path / "realsense", photo.intrinsics, [photo.depth_m] * 2, [photo.rgb] * 2)
    argv = ["generate", "--room", str(tmp_path), "--photo", "1", "--text", WALK, "--out", str(tmp_path / "out")]
    assert main([*argv, "--frames", "2", "--no-pictures"]) == 0
    capsys.readouterr()
    meta = json.loads((tmp_path / "out" / "meta.json").read_text())
    assert set(meta["inputs"]) == {"photo", "depth", "rgb"}
    assert any("Photo 1 of the capture" in sentence for sentence in meta["assumed"])
    assert main([*argv[:-1], str(tmp_path / "no"), "--depth", "depth.png"]) == 2
    assert main([*argv[:3], "--photo", "7", *argv[5:-1], str(tmp_path / "no")]) == 2
    assert capsys.readouterr().err.count("\n") == 2
    assert not (tmp_path / "no").exists()


def test_two_people(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    argv = ["generate", "--demo", "--text", WALK, "--text", "a man claps", "--frames", "3", "--no-pictures", "--out"]
    assert main([*argv, str(tmp_path / "two"), "--at=-0.6,2.2", "--at", "0.5,2.0"]) == 0
    assert capsys.readouterr().out.count("person: ") == 2
    assert read_npz(tmp_path / "two" / "pose.npz")["joints_m"].shape == (2, 3, 22, 3)
    assert main([*argv, str(tmp_path / "no"), *["--at", "0.5,2.0"] * 3]) == 2
    assert "at most 2 places" in capsys.readouterr().err
    assert not (tmp_path / "no").exists()


@pytest.mark.parametrize("depth", ["depth.png", "depth.npy"])
def test_own_pictures(pictures: Path, depth: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "walk"
    argv = ["generate", "--rgb", str(pictures / "rgb.png"), "--depth", str(pictures / depth)]
    argv += ["--camera", str(pictures / "camera.json"), "--text", WALK, "--out", str(out), "--frames", "3", "--json"]
    assert main([*argv, "--no-pictures"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["out"] == str(out)
    meta = json.loads((out / "meta.json").read_text())
    assert set(meta["inputs"]) == {"rgb", "depth", "camera"}
    assert all(len(entry["sha256"]) == 64 for entry in meta["inputs"].values())
    assert summary["assumed"] == meta["assumed"]


@pytest.mark.parametrize(("method", "error_db"), [("physics", -60), ("weaver", -34)])
def test_a_bin_goes_back_through_process(tmp_path: Path, method: str, error_db: float):
    """Physics processes its own samples; the network renders cube and samples of the same paths."""
    walk, again = tmp_path / "walk", tmp_path / "again"
    argv = ["generate", "--demo", "--out", str(walk), "--frames", "3", "--text", WALK, "--bin", "--quiet"]
    assert main([*argv, "--iq-order", "qi", "--tx-order", "0,1,2", "--no-pictures", "--method", method]) == 0
    meta = json.loads((walk / "meta.json").read_text())["adc_data_bin"]
    assert (meta["iq_order"], meta["tx_order"]) == ("qi", [0, 1, 2])
    words = ["process", str(walk / "adc_data.bin"), "--radar", str(walk / "radar.json"), "--iq-order", "qi"]
    assert main([*words, "--out", str(again), "--quiet"]) == 0
    made, read = (read_radar_npz(folder / "radar.npz").values for folder in (walk, again))
    read = read / meta["counts_per_unit"]
    assert 20 * np.log10(np.linalg.norm(read - made) / np.linalg.norm(made)) < error_db


BOARD_CFG = """channelCfg 15 7 0
adcCfg 2 1
adcbufCfg 0 1 0 1
profileCfg 0 77 267 7 57.14 0 0 70 1 240 4884 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
chirpCfg 2 2 0 0 0 0 0 2
frameCfg 0 2 16 0 100 1 0
cfarCfg 0 2 8 4 3 0 1280
peakGrouping 1 1 1 1 229
multiObjBeamForming 1 0.5
clutterRemoval 1
"""


def test_points_as_a_board_reports_them(tmp_path: Path):
    """On the board's steps of 4.09 cm, hardly anything that stands still, and the settings in meta.json."""
    (tmp_path / "board.cfg").write_text(BOARD_CFG)
    out = tmp_path / "board"
    argv = ["generate", "--demo", "--radar", str(tmp_path / "board.cfg"), "--points", "firmware", "--frames", "5"]
    assert main([*argv, "--text", WALK, "--out", str(out), "--quiet", "--no-pictures"]) == 0
    points = read_npz(out / "points.npz")
    assert len(points["frame"]) > 10
    assert np.mean(points["radial_velocity_mps"] == 0) < 0.4
    seen = points["y_m"] > 0  # angles that leave no way ahead put a point off its range
    step = np.sqrt(points["x_m"] ** 2 + points["y_m"] ** 2 + points["z_m"] ** 2) / (0.043569 * 240 / 256)
    assert np.abs(step - np.rint(step))[seen].max() < 0.06
    assert len(points["intensity"]) == len(points["frame"])
    meta = json.loads((out / "meta.json").read_text())
    assert meta["points"] == "firmware"
    assert meta["firmware"]["static_removal"] is True
    assert meta["firmware"]["range_cfar"]["threshold"] == 1280


@pytest.fixture(scope="module")
def bad_pictures(pictures: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Everything that can be wrong with a depth picture, next to good ones; nothing is written there."""
    good, folder = pictures, tmp_path_factory.mktemp("bad")
    for name in ("rgb.png", "depth.png", "camera.json"):
        (folder / name).write_bytes((good / name).read_bytes())
    depth = np.asarray(Image.open(good / "depth.png"))
    Image.fromarray(depth[::2, ::3]).save(folder / "small.png")
    Image.fromarray(np.zeros_like(depth)).save(folder / "zero.png")
    Image.fromarray((depth // 40).astype(np.uint8)).save(folder / "eight_bit.png")
    metres = depth / 1000.0
    np.save(folder / "nan.npy", np.full_like(metres, np.nan))
    np.save(folder / "negative.npy", -metres - 1)
    np.save(folder / "millimetres.npy", metres * 1000)
    np.save(folder / "objects.npy", np.array([{}], dtype=object))
    (folder / "cut.png").write_bytes((good / "depth.png").read_bytes()[:1000])
    (folder / "text.png").write_text("no picture")
    (folder / "camera_broken.json").write_text("{")
    (folder / "camera_short.json").write_text('{"fx": 500}')
    (folder / "lines.cfg").write_text("sensorStop\nflushCfg\n")
    (folder / "full").mkdir()
    (folder / "full" / "mine.txt").write_text("mine")
    (folder / "file").write_text("a file")
    return folder


PICTURES = ["--rgb", "rgb.png", "--depth", "depth.png", "--camera", "camera.json"]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "--demo"),
        (["--rgb", "rgb.png"], "--depth"),
        (["--depth", "depth.png"], "--rgb"),
        (["--demo", "--rgb", "rgb.png"], "--demo"),
        (["--rgb", "missing.png", "--depth", "depth.png"], "missing.png"),
        (["--rgb", "text.png", "--depth", "depth.png"], "text.png"),
        (["--rgb", "rgb.png", "--depth", "missing.png"], "missing.png"),
        (["--rgb", "rgb.png", "--depth", "cut.png"], "cut.png"),
        (["--rgb", "rgb.png", "--depth", "text.png"], "text.png"),
        (["--rgb", "rgb.png", "--depth", "objects.npy"], "objects.npy"),
        (["--rgb", "rgb.png", "--depth", "small.png"], "small.png"),
        (["--rgb", "rgb.png", "--depth", "zero.png"], "zero.png"),
        (["--rgb", "rgb.png", "--depth", "nan.npy"], "nan.npy"),
        (["--rgb", "rgb.png", "--depth", "negative.npy"], "negative.npy"),
        (["--rgb", "rgb.png", "--depth", "millimetres.npy"], "millimetres.npy"),
        (["--rgb", "rgb.png", "--depth", "eight_bit.png"], "eight_bit.png"),
        ([*PICTURES[:4], "--camera", "missing.json"], "missing.json"),
        ([*PICTURES[:4], "--camera", "camera_broken.json"], "camera_broken.json"),
        ([*PICTURES[:4], "--camera", "camera_short.json"], "camera_short.json"),
        ([*PICTURES, "--text", ""], "empty"),
        ([*PICTURES, "--text", "walk " * 2000], "10000 characters"),
        ([*PICTURES, "--text", "a person photosynthesises"], "walking"),
        ([*PICTURES, "--frames", "0"], "2000"),
        ([*PICTURES, "--frames", "1000000"], "2000"),
        ([*PICTURES, "--fps", "-1"], "fps"),
        ([*PICTURES, "--seed", "-1"], "seed"),
        ([*PICTURES, "--at", "1"], "X,Y"),
        ([*PICTURES, "--at", "-50,2"], "-50"),
        ([*PICTURES, "--radar", "nope"], "awr1843"),
        ([*PICTURES, "--radar", "lines.cfg"], "lines.cfg"),
        ([*PICTURES, "--radar", "missing.json"], "missing.json"),
        ([*PICTURES, "--background", "nowhere"], "does not exist"),
        ([*PICTURES, "--method", "magic"], "physics"),
        ([*PICTURES, "--tx-order", "0,1"], "tx_order"),
        ([*PICTURES, "--out", "full"], "--overwrite"),
        ([*PICTURES, "--out", "file"], "file"),
        ([*PICTURES, "--out", "file/inside"], "file"),
    ],
    ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else None,
)
def test_bad_input_is_one_line_and_writes_nothing(
    words: list[str], says: str, bad_pictures: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    before = sorted(str(file) for file in bad_pictures.rglob("*"))
    monkeypatch.chdir(bad_pictures)
    text = [] if "--text" in words else ["--text", WALK]
    out = [] if "--out" in words else ["--out", "walk"]
    assert main(["generate", *text, *out, *words]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("mmweaver: error: ")
    assert captured.err.count("\n") == 1
    assert len(captured.err) < 500
    assert says in captured.err
    assert captured.out == ""
    assert sorted(str(file) for file in bad_pictures.rglob("*")) == before


@pytest.mark.parametrize("words", [["--seconds", "0"], ["--fps", "0"], ["--text", "a person photosynthesises"]])
def test_a_mistake_is_said_before_pytorch_is_loaded(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    for name in ("torch", "mmweaver.weaver.front_door"):
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["generate", "--demo", *words]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(
    ("raised", "status", "word"),
    [
        (OSError(28, "No space left on device"), 2, "No space left"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (MemoryError(), 2, "memory"),
    ],
)
def test_what_stops_it_halfway_leaves_nothing(
    raised: BaseException, status: int, word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    def stop(*_: object) -> None:
        raise raised

    monkeypatch.setitem(PREVIEWS, "preview.png", stop)
    assert main(["generate", "--demo", "--frames", "1", "--text", WALK, "--out", str(tmp_path / "out")]) == status
    captured = capsys.readouterr()
    assert word in captured.err
    assert captured.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
