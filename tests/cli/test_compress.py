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
