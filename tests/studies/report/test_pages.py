"""Tables in pages: unknown ones are errors, every occurrence is filled, every page is checked."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.report.pages import MARKED, fill, pages_of, with_tables
from studies.report.tables import TABLES

ROOT = Path(__file__).resolve().parents[3]
RESULTS = ROOT / "results"


def test_pages_are_readme_docs_and_model_cards():
    pages = {page.relative_to(ROOT).as_posix() for page in pages_of(ROOT)}
    assert {"README.md", "docs/fields.md", "docs/evidence/weaver.md"} <= pages


def test_every_declared_table_is_on_a_page():
    shown = {found["name"] for page in pages_of(ROOT) for found in MARKED.finditer(page.read_text())}
    assert shown == set(TABLES)


def test_every_occurrence_is_filled():
    text = "<!-- table: real_rooms -->\nstale\n<!-- end -->\n"
    filled = with_tables(text + "between\n" + text, RESULTS)
    assert "stale" not in filled
    assert filled.count("| bundled sample | 337 | 100 % | 36 % |") == 2
    assert "\nbetween\n" in filled
    assert with_tables(filled, RESULTS) == filled


def test_unknown_tables_and_missing_ends_are_errors(tmp_path: Path):
    with pytest.raises(InputError, match="no_such_table"):
        with_tables("<!-- table: no_such_table --><!-- end -->", RESULTS)
    for text in ("<!-- table: real_rooms -->", "<!-- table: real_rooms --> <!-- table: physics --> <!-- end -->"):
        with pytest.raises(InputError, match="end -->"):
            with_tables(text, RESULTS)
    with pytest.raises(InputError, match=r"inr_paper\.json"):
        with_tables("<!-- table: field_fidelity --><!-- end -->", tmp_path)
    for text in ("nothing marked", "a mark is written `<!-- table: NAME -->`"):
        assert with_tables(text, tmp_path) == text


def test_a_page_is_written_only_where_it_changes(tmp_path: Path):
    page = tmp_path / "page.md"
    page.write_text("<!-- table: real_rooms --><!-- end -->\n")
    assert fill(page, RESULTS)
    assert "| room | frames |" in page.read_text()
    assert not fill(page, RESULTS)
