"""Pages with generated tables: README, docs and model cards, each table between two marks; scores: `card_scores`.

<!-- table: NAME -->
...
<!-- end -->
"""

import re
from pathlib import Path

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from studies.report.card_scores import MODELS, ROOT, CardScores, with_scores
from studies.report.tables import TABLES

MARKED = re.compile(
    r"(?<!`)<!-- table: (?P<name>[^>]*?) -->(?P<table>.*?)<!-- (?P<end>end|table: [^>]*?) -->", re.DOTALL
)
BEGIN, END = "<!-- table: {} -->", "<!-- end -->"
PAGES = ("README.md", "docs/**/*.md", "model_cards/**/*.md", "src/mmweaver/weights/README.md")


def pages_of(root: Path) -> list[Path]:
    """Every page of the documentation that has a table, and every model card."""
    pages = sorted({path for pattern in PAGES for path in root.glob(pattern)})
    return [page for page in pages if _scores_of(page) or MARKED.search(page.read_text(encoding="utf-8"))]


def filled_page(page: Path, results: Path) -> str:
    """The text of a page with its tables filled, and of a model card with its scores. Raises InputError."""
    text = with_tables(page.read_text(encoding="utf-8"), results, page.name)
    scores = _scores_of(page)
    return text if scores is None else with_scores(text, scores, results)


def _scores_of(page: Path) -> CardScores | None:
    return next((scores for name, scores in MODELS.items() if page == ROOT / name), None)


def fill(page: Path, results: Path) -> bool:
    """Fills the tables and scores of a page; returns whether anything changed. Raises InputError as `filled_page`."""
    after = filled_page(page, results)
    if after == page.read_text(encoding="utf-8"):
        return False
    with atomic_file(page) as temporary:
        temporary.write_text(after, encoding="utf-8")
    return True


def with_tables(text: str, results: Path, name: str = "the page") -> str:
    """A page with every occurrence of every table filled. Raises InputError for an unknown table or a missing end."""

    def filled(found: re.Match[str]) -> str:
        table = found["name"]
        if table not in TABLES:
            raise InputError(f"{name} asks for table {table!r}, which is not declared; known: {', '.join(TABLES)}")
        if found["end"] != "end":
            raise InputError(f"{name}: the mark of table {table!r} has no {END} after it")
        return f"{BEGIN.format(table)}\n{TABLES[table](results)}\n{END}"

    after = MARKED.sub(filled, text)
    begun = len(re.findall(r"(?<!`)<!-- table: ", text))
    ended = len(re.findall(rf"(?<!`){END}", text))
    if begun > ended:
        raise InputError(f"{name}: {begun - ended} table(s) lack the mark {END}")
    return after
