import errno
import json
import re
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.io.npz_files import write_radar_npz
from tests.compression.echoes import SMALL, crowd


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    write_radar_npz(tmp_path / "radar.npz", crowd())
    (tmp_path / "radar.json").write_text(SMALL.to_json())
    return tmp_path / "radar.npz"


def test_a_cube_and_a_size(recording: Path, capsys: pytest.CaptureFixture[str]):
    out = recording.with_name("a.mmw")
    assert main(["compress", str(recording), "-o", str(out), "--bytes", "3000", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["bytes"] == out.stat().st_size <= 3000
    assert summary["frames"] == 3
    assert -70 < summary["signal_error_db"] <= summary["all_error_db"] < -10
    assert main(["compress", str(recording), "-o", str(out), "--bytes", "3000"]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert main(["compress", str(recording), "-o", str(out), "--quality", "15", "--overwrite"]) == 0
    shown = capsys.readouterr().out
    assert "times fewer" in shown
    signal_db, all_db = (float(value) for value in re.findall(r"(-[\d.]+) dB", shown))
    assert -15.6 < signal_db <= -15.0
    assert all_db >= signal_db
    assert "better than asked" not in shown
    assert main(["compress", str(recording), "-o", str(out), "--bytes", "9000", "--overwrite"]) == 0


def test_a_file_that_may_not_grow_is_named(
    recording: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def refused(*_: object) -> int:
        raise OSError(errno.EFBIG, "File too large")

    monkeypatch.chdir(recording.parent)
    monkeypatch.setattr(Path, "write_bytes", refused)
    assert main(["compress", str(recording), "--bytes", "3000", "-o", "a.mmw"]) == 2
    assert re.search(r"cannot write \S+\.mmw: File too large", capsys.readouterr().err)
    assert not Path("a.mmw").exists()


def test_raw_samples_need_their_radar(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    rng = np.random.default_rng(0)
    shape = (2, 16, 3, 4, 128)
    np.save(tmp_path / "adc.npy", (rng.normal(size=shape) + 1j * rng.normal(size=shape)).astype(np.complex64))
    (tmp_path / "radar.json").write_text(SMALL.to_json())
    words = ["compress", str(tmp_path / "adc.npy"), "-o", str(tmp_path / "a.mmw"), "--bytes", "4000"]
    assert main(words) == 2
    assert "--layout" in capsys.readouterr().err
    words += ["--layout", "frame,loop,tx,rx,sample"]
    assert main(words) == 2
    assert "--radar" in capsys.readouterr().err
    assert main([*words, "--radar", str(tmp_path / "radar.json"), "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert (tmp_path / "a.mmw").stat().st_size <= 4000


def test_an_array_of_another_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """HuPR's shape is known; mmMesh's is also RF-Genesis's, so it must be named."""
    from tests.io.test_peer_arrays import hupr_array, simulated_frame

    np.save(tmp_path / "000000001.npy", hupr_array(simulated_frame()))
    words = ["compress", str(tmp_path / "000000001.npy"), "-o", str(tmp_path / "a.mmw"), "--bytes", "9000", "--json"]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)["cube_bytes"] == 64 * 64 * 12 * 8
    np.save(tmp_path / "frame.npy", np.zeros((3, 4, 128, 256), np.complex64))
    words = ["compress", str(tmp_path / "frame.npy"), "-o", str(tmp_path / "b.mmw"), "--bytes", "9000"]
    assert main(words) == 2
    assert "mmmesh or rf_genesis" in capsys.readouterr().err
    assert main([*words, "--layout", "nobody"]) == 2
    assert main([*words, "--layout", "hupr"]) == 2
    message = capsys.readouterr().err.splitlines()
    assert len(message) == 2
    assert "HuPR's are complex" in message[1]
    assert not (tmp_path / "b.mmw").exists()


@pytest.mark.parametrize(
    "words", [["--bytes", "9"], ["--bytes", "x"], ["--quality", "900"], [], ["--bytes", "999", "--quality", "9"]]
)
def test_bad_wishes_leave_nothing_behind(words: list[str], recording: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["compress", str(recording), "-o", str(recording.with_name("a.mmw")), *words]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not recording.with_name("a.mmw").exists()


def test_frames_are_added(recording: Path, capsys: pytest.CaptureFixture[str]):
    from mmweaver.compression.mmw_codec import read_cube

    out = recording.with_name("a.mmw")
    for words in ([], ["--append", "--preset", "fast"]):
        assert main(["compress", str(recording), "-o", str(out), "--bytes", "2000", *words]) == 0
    assert "added to" in capsys.readouterr().out
    assert len(read_cube(out).values) == 6
    assert out.stat().st_size <= 4000
    assert main(["compress", str(recording), "-o", str(out), "--bytes", "2000", "--append", "--overwrite"]) == 2
