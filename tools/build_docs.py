"""Builds the documentation site (make docs): pages, references, gallery and notebooks; nothing it writes is committed.

python tools/build_docs.py [--out build/docs]
"""

import argparse
import json
import os
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mmweaver.cli.arguments import Parser

ROOT = Path(__file__).resolve().parents[1]
TOP = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
FIRST = "first_signal"  # of the gallery
# what a browser fetches by itself: of elements, and of style sheets
REMOTE = re.compile(
    r"""(?:<(?:link|script|img|iframe)\b[^>]*?(?:href|src)=|@import\s*|url\()\s*["']?((?:https?:)?//[^"')>\s]+)"""
)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "docs")
    out = parser.parse_args().out.resolve()
    del sys.argv[1:]  # examples read their own arguments
    source = out / "source"
    if out.exists():
        shutil.rmtree(out)
    shutil.copytree(ROOT / "docs", source)
    for name, page in TOP.items():
        text = with_local_links((ROOT / name).read_text(encoding="utf-8"))
        (source / page).write_text(text.replace("](docs/", "]("), encoding="utf-8")
    decisions = decision_navigation(source / "decisions")
    write_references(source / "reference")
    write_gallery(source / "gallery")
    (source / "reference" / "studies.md").write_text(list_of_studies(), encoding="utf-8")
    for page in source.rglob("*.md"):
        page.write_text(rewritten(page.read_text(encoding="utf-8"), page, source), encoding="utf-8")
    settings = (ROOT / "zensical.toml").read_text(encoding="utf-8")
    for place in ("src", "tools/docstring_blocks.py"):
        settings = settings.replace(f'["{place}"]', f'["{(ROOT / place).as_posix()}"]')
    settings = settings.replace('["decisions/index.md"] }, # decisions', f'["decisions/index.md", {decisions}] }},')
    (out / "zensical.toml").write_text(settings, encoding="utf-8")
    zensical = Path(sys.executable).with_name("zensical")
    status = subprocess.run([zensical, "build", "--strict", "-f", out / "zensical.toml"], check=False).returncode
    faults = faults_of(out / "site")
    print("\n".join(faults) or f"{out / 'site' / 'index.html'}")
    return status or bool(faults)


def with_local_links(text: str) -> str:
    """A page whose links to files of the repository, absolute for readers elsewhere, begin at its root."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    source = project["urls"]["Source"]
    pictures = source.replace("github.com", "raw.githubusercontent.com")
    return text.replace(f"]({source}/blob/main/", "](").replace(f"]({pictures}/main/", "](")


def rewritten(text: str, page: Path, source: Path) -> str:
    """The page with its links as the site has them: pages of the root renamed, files outside the site as plain text."""

    def link(found: re.Match[str]) -> str:
        words, target = found.groups()
        place, _, anchor = target.partition("#")
        if re.match(r"(https?|mailto):", target) or not place:
            return found[0]
        name = Path(place).name
        if name in TOP and not (page.parent / place).exists():
            up = "../" * len(page.relative_to(source).parent.parts)
            return f"[{words}]({up}{TOP[name]}{'#' + anchor if anchor else ''})"
        inside = (page.parent / place).resolve().is_relative_to(source)
        return found[0] if inside and (page.parent / place).exists() else words

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def decision_navigation(folder: Path) -> str:
    """Makes the list of decisions the front page of their folder; returns their navigation by subject."""
    page = (folder / "README.md").rename(folder / "index.md")
    entries = []
    for subject, records in re.findall(r"^## (.*)\n\n((?:- .*\n)+)", page.read_text(encoding="utf-8"), re.MULTILINE):
        pages = [
            f'{{ {json.dumps(title, ensure_ascii=False)} = "decisions/{name}" }}'  # quoted as TOML quotes it, too
            for title, name in re.findall(r"^- \[(.*?)\]\((.*?)\)", records.replace("`", ""), re.MULTILINE)
        ]
        entries.append(f'{{ "{subject}" = [{", ".join(pages)}] }}')
    return ", ".join(entries)


def write_references(folder: Path) -> None:
    """Writes the pages of the command line and of the public names; modules behind them are not for users' searches."""
    from mmweaver import _HOME
    from mmweaver import __all__ as public
    from mmweaver.cli.main import build_parser

    os.environ["COLUMNS"] = "110"  # width of the help
    folder.mkdir()
    (folder / "cli.md").write_text(command_line(build_parser()), encoding="utf-8")
    names = [f"::: mmweaver.{_HOME[name]}.{name}" for name in public if name in _HOME]
    head = "# Python\n\nWhat `from mmweaver import ...` gives.\n\n"
    (folder / "api.md").write_text(head + "\n\n".join(names) + "\n", encoding="utf-8")


def list_of_studies() -> str:
    """What `python -m studies list` prints."""
    command = [sys.executable, "-m", "studies", "list"]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return (
        f"# Studies\n\n`python -m studies run NAME` repeats one; `--help` lists its options.\n\n```text\n{listed}```\n"
    )


def command_line(parser: "Parser") -> str:
    """The help of every command, with all options."""
    parts = ["# Command line", "", "```text", parser.format_help().rstrip(), "```"]
    commands = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    pending = [(name, sub) for action in commands for name, sub in action.choices.items()]
    while pending:
        name, sub = pending.pop(0)
        parts += ["", f"## {parser.prog} {name}", "", "```text", sub.format_help().rstrip(), "```"]
        nested = [action for action in sub._actions if isinstance(action, argparse._SubParsersAction)]
        pending = [(f"{name} {more}", deep) for action in nested for more, deep in action.choices.items()] + pending
    return "\n".join(parts) + "\n"


def write_gallery(folder: Path) -> None:
    """Runs every example and writes a page with its code, what it printed and its pictures, and a notebook of each."""
    import jupytext
    from nbformat.v4 import new_markdown_cell

    folder.mkdir()
    page = ["# Gallery", "", "Each of these is a file of `examples/`, run as it is when this site is built.", ""]
    for script in sorted((ROOT / "examples").glob("*.py"), key=lambda path: (path.stem != FIRST, path.stem)):
        code = script.read_text(encoding="utf-8")
        work = folder / script.stem
        work.mkdir()
        printed = StringIO()
        with chdir(work), redirect_stdout(printed):
            runpy.run_path(str(script), run_name="__main__")
        notebook = jupytext.reads(code, fmt="py:percent")
        title, _, usage = notebook.cells[0].source.strip().strip('"').partition("\n")  # the docstring
        title = title.rstrip(".")
        notebook.cells[0] = new_markdown_cell(f"# {title}\n{usage}")
        jupytext.write(notebook, folder / f"{script.stem}.ipynb")
        page += [f"## {title}", usage, ""]
        for cell in notebook.cells[1:]:
            page += [cell.source if cell.cell_type == "markdown" else f"```python\n{cell.source}\n```", ""]
        page += ["It prints", "", f"```text\n{printed.getvalue().rstrip()}\n```", ""]
        page += [f"![{title}]({script.stem}/{picture.name})\n" for picture in sorted(work.glob("*.png"))]
        page += [f"[As a notebook]({script.stem}.ipynb)", ""]
        for other in [path for path in sorted(work.rglob("*"), reverse=True) if path.suffix != ".png"]:
            other.rmdir() if other.is_dir() and not any(other.iterdir()) else other.is_file() and other.unlink()
    (folder / "index.md").write_text("\n".join(page), encoding="utf-8")


def faults_of(site: Path) -> list[str]:
    """What a visitor's browser would fetch from another server, and local links that lead nowhere."""
    faults = []
    for page in sorted(site.rglob("*.html")):
        text = page.read_text(encoding="utf-8")
        where = page.relative_to(site)
        faults += [f"{where} requests {target}" for target in REMOTE.findall(text)]
        body = re.sub(r"<script\b.*?</script>", "", text, flags=re.DOTALL)
        for target in re.findall(r"""(?:href|src)="([^"#?]+)""", body):
            if re.match(r"(https?:|mailto:|data:|//)", target):
                continue
            if not (site / target[1:] if target.startswith("/") else page.parent / target).exists():
                faults.append(f"{where} links to {target}, which is not there")
    for style in sorted(site.rglob("*.css")):
        faults += [
            f"{style.relative_to(site)} requests {target}"
            for target in REMOTE.findall(style.read_text(encoding="utf-8"))
        ]
    return faults


if __name__ == "__main__":
    raise SystemExit(main())
