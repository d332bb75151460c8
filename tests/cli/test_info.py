import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.compression.mmw_codec import compress_cube
from tests.compression.echoes import crowd


def test_what_a_file_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    path = tmp_path / "a.mmw"
    path.write_bytes(compress_cube(crowd(num_frames=2), num_bytes=2500))
    assert main(["info", str(path)]) == 0
    text = capsys.readouterr().out
    for word in ("2 x 24 x 16 x 12", "scatterers", "12 antennas", "every checksum right"):
        assert word in text
    assert main(["info", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["shape"] == [2, 24, 16, 12]
    assert main(["info", str(tmp_path / "none.mmw")]) == 2
    assert "cannot read" in capsys.readouterr().err
