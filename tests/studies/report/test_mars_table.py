from pathlib import Path

from studies.report.mars_table import table

ROOT = Path(__file__).resolve().parents[3]


def test_the_page_holds_the_table_of_the_results():
    """Make it again with: python -m studies tables."""
    assert table(ROOT / "results" / "mars") in (ROOT / "docs" / "reality.md").read_text()


def test_floors_come_first_and_what_does_not_apply_is_a_dash():
    lines = table(ROOT / "results" / "mars").splitlines()
    assert lines[2].startswith("| floor centroid | ")
    assert lines[6].startswith("| simulator | ")
    assert lines[2].endswith(" - | - | - | - |") or " - |" in lines[2]
