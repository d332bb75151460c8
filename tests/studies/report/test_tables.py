from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.report.pages import with_tables

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize(
    ("document", "told"),
    [
        ("docs/fields.md", "inr_paper"),
        ("README.md", "person in place"),
        ("docs/limits.md", "recorded"),
        ("docs/several_people.md", "side by side"),
        ("docs/rooms.md", "seats found"),
        ("docs/motion.md", "standing up from the knees"),
        ("docs/motiongpt.md", "ceiling"),
        ("docs/zero_shot.md", "blind"),
        ("docs/weaver.md", "wrong_photo"),
    ],
)
def test_the_tables_of_the_documentation_are_those_of_the_results(document: str, told: str):
    """If this fails: python -m studies tables"""
    text = (ROOT / document).read_text(encoding="utf-8")
    assert with_tables(text, ROOT / "results") == text
    assert told in text


def test_marks_need_an_end_and_tables_their_results(tmp_path: Path):
    with pytest.raises(InputError, match="run the experiment"):
        with_tables("<!-- table: field_fidelity --><!-- end -->", tmp_path)
    with pytest.raises(InputError, match="lack the mark"):
        with_tables("<!-- table: super_resolution -->", ROOT / "results")
    assert with_tables("nothing marked", tmp_path) == "nothing marked"
