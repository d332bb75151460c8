"""Writes the table of docs/formats.md from src/mmweaver/io/formats.toml; with --check, fails if it is another."""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE, ROWS = ROOT / "docs" / "formats.md", ROOT / "src" / "mmweaver" / "io" / "formats.toml"
HEAD = "| file | read or written by | layout, note | sample or generator |\n| --- | --- | --- | --- |\n"


def page_with_table(text: str, rows: list[dict[str, str]]) -> str:
    """The page with its table made of the rows."""
    lines = [f"| {row['file']} | {row['by']} | {row.get('note', '')} | `{row['test']}` |\n" for row in rows]
    before, after = text.split(HEAD)
    return before + HEAD + "".join(lines) + after[after.index("\n\n") + 1 :]


def main() -> int:
    """Writes or checks the page."""
    text = PAGE.read_text(encoding="utf-8")
    made = page_with_table(text, tomllib.loads(ROWS.read_text(encoding="utf-8"))["format"])
    if "--check" in sys.argv:
        return int(made != text)
    PAGE.write_text(made, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
