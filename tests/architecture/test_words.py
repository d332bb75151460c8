"""Words that a radar engineer would not write do not appear in pages, help and messages."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
# without the words that sentences may hold
SOURCES = sorted(
    set((ROOT / "src" / "mmweaver").rglob("*.py"))
    - set((ROOT / "src" / "mmweaver" / "motion" / "language").rglob("*.py"))
)
ODD = {
    r"\bbeside\b": "next to",
    r"\bgives?\b[^.;|]{0,30}\baway\b": "separates, identifies",
    r"\bnobody's\b": "of no person",
    r"\bwhat rests\b": "static",
    r"\bmay be had\b": "is available",
    r"\b(?:points|loops|joints|numbers|values|words|samples|bytes|kB|MB|MiB|ms|s|Hz|\d) a frame\b": "per frame",
    r"\bis told to\b": "is asked to, must",
}  # what stands there -> what would be written


def odd_words(text: str) -> list[str]:
    text = re.sub(r"```.*?```|`[^`]*`", "", text, flags=re.DOTALL)
    return [f"{found[0]!r}: write {better!r}" for odd, better in ODD.items() for found in re.finditer(odd, text)]


def strings_of(path: Path) -> str:
    """Messages, help and docstrings of a module."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return "\n".join(
        node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_pages_are_in_the_words_of_the_field(page: Path):
    assert not odd_words(page.read_text(encoding="utf-8"))


def test_messages_and_help_are_in_the_words_of_the_field():
    found = {str(path.relative_to(ROOT)): odd_words(strings_of(path)) for path in SOURCES}
    assert not {name: words for name, words in found.items() if words}


def test_an_odd_phrase_is_found():
    assert odd_words("a chair stands beside the desk, 300 points a frame") != []
    assert odd_words("`beside` was renamed; the phase of a frame") == []
