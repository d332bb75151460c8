from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.compression.mmw_codec import compress_cube
from mmweaver.io.npz_files import read_radar_npz
from tests.compression.echoes import crowd, error_db


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mmw") / "a.mmw"
    path.write_bytes(compress_cube(crowd(), num_bytes=4000))
    return path


def test_back_to_npz(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "radar.npz"
    assert main(["decompress", str(file), "-o", str(out)]) == 0
    assert "3 frames" in capsys.readouterr().out
    cube = read_radar_npz(out)
    assert error_db(cube.values, crowd().values) < -20
    assert main(["decompress", str(file), "-o", str(out)]) == 2
    assert main(["decompress", str(file), "-o", str(out), "--frames", "1:2", "--overwrite", "--quiet"]) == 0
    assert np.array_equal(read_radar_npz(out).values, cube.values[1:2])


@pytest.mark.parametrize("words", [["--frames", "7"], ["--frames", "a:b"], ["--frames", "5:9"]])
def test_frames_that_are_not_there(words: list[str], file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["decompress", str(file), "-o", str(tmp_path / "radar.npz"), *words]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_damaged_file_leaves_nothing(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data = bytearray(file.read_bytes())
    data[-20] ^= 4
    (tmp_path / "b.mmw").write_bytes(bytes(data))
    assert main(["decompress", str(tmp_path / "b.mmw"), "-o", str(tmp_path / "out" / "radar.npz")]) == 2
    assert "checksum" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
