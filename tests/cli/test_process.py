"""mmweaver process: recordings of a radar become the same files; what is no recording becomes one line."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.boards import AWR1843, typical_board
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.npz_files import read_points_npz, read_radar_npz
from tests.captures import counts, radar_of_cfg, write_radar

BARE_CFG = """channelCfg 15 7 0
adcCfg 2 1
profileCfg 0 77 267 7 57.14 0 0 70 1 240 4884 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
frameCfg 0 0 16 0 100 1 0
"""


def make_adc(num_frames: int = 2) -> AdcCube:
    """One still point at 2 m straight ahead, and noise."""
    shape = (num_frames, AWR1843.num_loops, AWR1843.num_tx, AWR1843.num_rx, AWR1843.num_samples)
    random = stream(0, "test")
    beat_hz = 2 * 2.0 * AWR1843.chirp_slope_hz_per_s / 299_792_458
    tone = np.exp(2j * np.pi * beat_hz * np.arange(AWR1843.num_samples) / AWR1843.sample_rate_hz)
    samples = 100 * tone + random.normal(size=shape) + 1j * random.normal(size=shape)
    return AdcCube(samples=samples.astype(np.complex64), config=AWR1843, scale=1.0)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    adc = make_adc()
    write_bin(folder / "adc_data.bin", adc)
    write_bin(folder / "qi.bin", adc, iq_order="qi")
    np.save(folder / "adc.npy", adc.samples[:, :, list(AWR1843.tx_order)])
    return folder


def test_a_bin_becomes_the_files_promised(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "capture"
    argv = ["process", str(recording / "adc_data.bin"), "--radar", "awr1843", "--tx-order", "0,2,1", "--out", str(out)]
    assert main(argv) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert "radar.npz" in captured.out
    names = {file.name for file in out.iterdir()}
    pictures = {"preview.png", "preview.gif"}
    assert (
        names
        == {"radar.npz", "points.npz", "radar.json", "meta.json", "request.toml", "SHA256SUMS", "analysis.npz"}
        | pictures
    )
    cube = read_radar_npz(out / "radar.npz")
    assert cube.values.shape == (2, 64, 32, 12)
    strongest = np.abs(cube.values).sum(axis=(0, 2, 3)).argmax()
    assert cube.grid.range_m[strongest] == pytest.approx(2.0, abs=0.03)
    assert np.isnan(cube.scale)
    points = read_points_npz(out / "points.npz")
    best = points.snr_db.argmax()
    assert (points.x_m[best], points.y_m[best]) == pytest.approx((0, 2), abs=0.05)
    meta = json.loads((out / "meta.json").read_text())
    assert meta["inputs"]["recording"]["path"].endswith("adc_data.bin")
    assert len(meta["inputs"]["recording"]["sha256"]) == 64


def test_both_iq_orders_and_npy_give_the_same_cube(recording: Path, tmp_path: Path):
    words = {
        "iq": ["adc_data.bin"],
        "qi": ["qi.bin", "--iq-order", "qi"],
        "npy": ["adc.npy", "--layout", "frame,loop,tx,rx,sample"],
    }
    cubes = []
    for name, (file, *more) in words.items():
        out = tmp_path / name
        assert main(["process", str(recording / file), *more, "--radar", "awr1843", "--out", str(out), "--quiet"]) == 0
        values = read_radar_npz(out / "radar.npz").values
        cubes.append(values / np.abs(values).max())
    assert np.array_equal(cubes[0], cubes[1])
    assert np.allclose(cubes[0], cubes[2], atol=1e-3)


def test_a_capture_folder_needs_no_option(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    write_radar(tmp_path / "capture_00000" / "iwr1843", counts(radar_of_cfg(tmp_path)))
    assert main(["process", str(tmp_path / "capture_00000"), "--out", str(tmp_path / "out"), "--json"]) == 0
    assert "radar.npz" in " ".join(json.loads(capsys.readouterr().out)["files"])
    assert read_radar_npz(tmp_path / "out" / "radar.npz").values.shape[0] == 3


@pytest.fixture(scope="module")
def bad(recording: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings and radars that are none; nothing is written there."""
    place = tmp_path_factory.mktemp("bad")
    whole = (recording / "adc_data.bin").read_bytes()
    (place / "whole.bin").write_bytes(whole)
    (place / "cut.bin").write_bytes(whole[:-100])
    (place / "empty.bin").write_bytes(b"")
    (place / "broken.json").write_text("{")
    (place / "bare.cfg").write_text(BARE_CFG)
    (place / "lines.cfg").write_text("sensorStop\nflushCfg\n")
    (place / "whole.npy").write_bytes((recording / "adc.npy").read_bytes())
    np.save(place / "objects.npy", np.array([{}], dtype=object))
    write_radar(place / "capture_00000" / "iwr1843", counts(radar_of_cfg(place), num_frames=1))
    (place / "capture_00001").mkdir()
    return place


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["missing.bin", "--radar", "awr1843"], "missing.bin"),
        (["cut.bin", "--radar", "awr1843", "--strict"], "whole frame"),
        (["empty.bin", "--radar", "awr1843"], "empty"),
        (["whole.bin", "--radar", "nope"], "awr1843"),
        (["whole.bin", "--radar", "broken.json"], "broken.json"),
        (["whole.bin", "--radar", "lines.cfg"], "lines.cfg"),
        (["whole.bin", "--radar", "awr1843", "--tx-order", "0,0,1"], "tx_order"),
        (["whole.bin", "--radar", "awr1843", "--tx-order", "x"], "--tx-order"),
        (["whole.bin", "--radar", "awr1843", "--iq-order", "xy"], "iq"),
        (["whole.bin", "--radar", "bgt60"], "no board for a DCA1000"),
        (["whole.bin", "--radar", "bgt60", "--points", "firmware"], "--points cfar"),
        (["whole.bin", "--radar", "awr1843", "--points", "lidar"], "firmware"),
        (["whole.bin", "--radar", "bare.cfg", "--points", "firmware"], "cfarCfg"),
        (["whole.bin"], "--radar"),
        (["capture_00000", "--radar", "awr1843"], "leave out --radar"),
        (["capture_00000", "--iq-order", "iq"], "leave out --iq-order"),
        (["capture_00001"], "folder"),
        (["whole.npy", "--radar", "awr1843"], "--layout"),
        (["whole.npy", "--radar", "awr1843", "--layout", "frame,loop"], "axes"),
        (["whole.npy", "--radar", "awr1843", "--layout", "frame,fish"], "fish"),
        (["objects.npy", "--radar", "awr1843", "--layout", "frame,loop"], "objects.npy"),
    ],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_bad_input_is_one_line_and_writes_nothing(
    words: list[str], says: str, bad: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    before = sorted(file.name for file in bad.iterdir())
    monkeypatch.chdir(bad)
    assert main(["process", *words, "--out", "capture"]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("mmweaver: error: ")
    assert captured.err.count("\n") == 1
    assert says in captured.err
    assert captured.out == ""
    assert sorted(file.name for file in bad.iterdir()) == before


def test_a_board_is_taken_away(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    board = replace(typical_board(AWR1843, 3), drift_ppm=0.3)
    board.save(tmp_path / "board.json")
    plain, mended = tmp_path / "plain", tmp_path / "mended"
    argv = ["process", str(recording / "adc_data.bin"), "--radar", "awr1843", "--no-pictures", "--no-analysis"]
    assert main([*argv, "--out", str(plain)]) == 0
    assert main([*argv, "--board", str(tmp_path / "board.json"), "--out", str(mended)]) == 0
    said = json.loads((mended / "meta.json").read_text())["board"]
    assert said["name"] == "typical:3"
    assert set(said["corrected"]) >= {"antenna errors", "IF response", "range bias", "first chirp"}
    assert any(one.startswith("drift") for one in said["left_in"])
    assert json.loads((plain / "meta.json").read_text())["board"] is None
    cubes = [read_radar_npz(folder / "radar.npz") for folder in (plain, mended)]
    loops = AWR1843.num_loops // 2
    places = []
    for cube in cubes:
        power = (np.abs(cube.values[0, :, loops]) ** 2).mean(axis=1)
        at = int(power.argmax())
        near = slice(at - 2, at + 3)
        places.append(float((power[near] * cube.grid.range_m[near]).sum() / power[near].sum()))
    assert places[0] - places[1] == pytest.approx(board.range_bias_m, abs=0.01)
    # a cube of a folder is corrected, too
    again = tmp_path / "again"
    assert main(["process", str(plain), "--board", str(tmp_path / "board.json"), "--no-pictures", "--no-analysis",
                 "--out", str(again)]) == 0  # fmt: skip
    from_cube = read_radar_npz(again / "radar.npz").values[:, 4:-4]
    whole = cubes[1].values[:, 4:-4]
    assert np.linalg.norm(from_cube - whole) < 0.15 * np.linalg.norm(whole)
    capsys.readouterr()
    (tmp_path / "none.json").write_text("{}")
    assert main([*argv, "--board", str(tmp_path / "none.json"), "--out", str(tmp_path / "nothing")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "nothing").exists()
