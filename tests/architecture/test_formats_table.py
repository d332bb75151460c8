"""docs/formats.md is the one table of formats: whatever the code reads or writes has a row, and each row a test."""

import re
import tomllib
from pathlib import Path

from mmweaver.datasets.export import FORMATS
from mmweaver.io.peer_arrays import LAYOUTS
from mmweaver.io.point_clouds.read_points import FORMATS as POINT_FORMATS
from mmweaver.recordings.read_recording import PACKET_SUFFIXES
from mmweaver.scene.scan_folders import FORMATS as SCANS
from mmweaver.scene.scanned_mesh.read_mesh import SUFFIXES
from tools.formats_page import page_with_table

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
ROWS = [line for line in PAGE.split("## Recipes", maxsplit=1)[0].splitlines() if line.startswith("| ")][2:]


def test_every_row_names_a_sample_or_generator_that_is_there():
    assert len(ROWS) > 35
    for row in ROWS:
        file = re.fullmatch(r".* \| `(tests/[\w/.]+)` \|", row)
        assert file is not None, row
        assert (ROOT / file.group(1)).is_file(), row


def test_the_table_is_made_of_the_registry():
    rows = tomllib.loads((ROOT / "src" / "mmweaver" / "io" / "formats.toml").read_text(encoding="utf-8"))["format"]
    assert page_with_table(PAGE, rows) == PAGE, "run: python tools/formats_page.py"


def test_every_format_of_the_code_has_a_row():
    table = "\n".join(ROWS)
    for name in FORMATS:
        assert f"export --to {name}`" in table, name
    for name in POINT_FORMATS:
        assert f"(`{name}`)" in table, name
    for name in LAYOUTS:
        assert f"--layout {name}`" in table, name
    for suffix in PACKET_SUFFIXES:
        assert f"`{suffix}`" in table, suffix
    for name in SCANS:
        assert name in table, name
    for suffix in SUFFIXES:
        assert suffix[1:].upper() in table, suffix
