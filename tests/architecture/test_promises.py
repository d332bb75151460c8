"""docs/security.md: each promise has a line that keeps it, and a test that fails without that line."""

import re
from collections import Counter
from pathlib import Path

from tools.mutants.promises import Promise, read_promises

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "security.md"
ROW = re.compile(r"^\| (?P<name>[^|]+) \| `(?P<test>tests/\S+::\w+)` \|$", re.MULTILINE)


def test_every_promise_has_its_line_once_and_its_test():
    promises = read_promises()
    assert len(promises) > 40
    assert max(Counter(one.name for one in promises).values()) == 1
    for one in promises:
        source = (ROOT / one.path).read_text(encoding="utf-8")
        assert source.count(f"{one.line}\n") == 1, f"{one.name}: {one.line!r} in {one.path}"
        compile(source.replace(f"{one.line}\n", f"{one.broken}\n"), one.file, "exec")
        file, _, name = one.test.partition("::")
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), one.test


def test_the_page_lists_them_all():
    rows = {row["name"]: row["test"] for row in ROW.finditer(PAGE.read_text(encoding="utf-8"))}
    assert rows == {one.name: one.test for one in read_promises()}


def test_a_broken_line_is_broken(tmp_path: Path):
    place = tmp_path / "src" / "mmweaver" / "a.py"
    place.parent.mkdir(parents=True)
    place.write_text("if limit:\n    check()\n")
    Promise(name="a", file="a.py", line="    check()", broken="    pass", test="").break_in(tmp_path)
    assert place.read_text() == "if limit:\n    pass\n"
