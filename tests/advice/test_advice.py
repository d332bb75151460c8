"""Whatever a message advises is done, and helps."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from tests.advice import rows_files, rows_generate, rows_motion, rows_photos, rows_repairs, rows_sets
from tests.advice.harness import Row, carry_out
from tests.advice.made_inputs import make, signals_made_once
from tests.advice.templates import templates

REVIEWED = tomllib.loads(Path(__file__).with_name("reviewed.toml").read_text(encoding="utf-8"))
ROWS: tuple[Row, ...] = (
    *rows_generate.ROWS,
    *rows_motion.ROWS,
    *rows_files.ROWS,
    *rows_sets.ROWS,
    *rows_repairs.ROWS,
    *rows_photos.ROWS,
)


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The files that the rows name."""
    return make(tmp_path_factory.mktemp("advice"))


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.text)
def test_advice_helps(row: Row, inputs: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    with signals_made_once(reads_photo=row.reads_photo):
        carry_out(row, inputs, capsys, tmp_path)


def test_every_text_that_names_an_option_or_a_command_is_tried_or_was_reviewed():
    tried = {row.template.text for row in ROWS}
    reviewed: set[str] = set()
    for text in (text for reason in REVIEWED.values() for text in reason["texts"]):
        found = {one.text for one in templates() if text == one.text}
        found = found or {one.text for one in templates() if text in one.text}
        assert len(found) == 1, f"{text!r} is part of {len(found)} texts"
        reviewed |= found
    assert not tried & reviewed, "both tried and reviewed"
    missing = [one for one in templates() if one.text not in tried and one.text not in reviewed]
    assert not missing, "\n".join(f"{one.file}:{one.line}: {one.text[:160]}" for one in missing)
