"""How large is the code? The figures by which the house is measured: python tools/size.py [--json] [FOLDER]

Tokens are those of Python's `tokenize` without comments, docstrings, line ends and indentation; an f-string counts as
one, as it did before Python 3.12. A line of code holds at least one such token. Only files are read, nothing of the
package is imported; the options of the command line are those that `mmweaver COMMAND --help-all` prints.
"""

import argparse
import ast
import io
import json
import os
import re
import subprocess
import sys
import tokenize
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

PACKAGE = Path("src/mmweaver")
LANGUAGE = PACKAGE / "motion" / "language"
MAX_PARAMETERS = 8
LAYOUT = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING,
          tokenize.ENDMARKER}  # fmt: skip
FSTRING_START, FSTRING_END = (getattr(tokenize, f"FSTRING_{name}", -1) for name in ("START", "END"))
PREPOSITIONS = frozenset(
    [
        "about", "after", "against", "along", "around", "as", "at", "before", "between", "beyond", "by", "for",
        "from", "in", "into", "near", "next", "of", "off", "on", "over", "past", "per", "since", "through", "to",
        "towards", "under", "until", "what", "where", "with", "within", "without",
    ]
)  # fmt: skip
REGEX = re.compile(r"\\[bsdwSDWB]|\(\?")
Function = ast.FunctionDef | ast.AsyncFunctionDef


def docstrings(tree: ast.AST) -> list[ast.Expr]:
    """The docstrings of a module, its classes and functions."""
    owners = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    bodies = [node.body for node in ast.walk(tree) if isinstance(node, owners) and node.body]
    return [body[0] for body in bodies if isinstance(body[0], ast.Expr) and isinstance(_constant(body[0].value), str)]


def _constant(node: ast.AST) -> Any:
    return node.value if isinstance(node, ast.Constant) else None


def source_figures(text: str) -> Counter[str]:
    """Tokens, lines of code and lines of docstrings of one file."""
    found = docstrings(ast.parse(text))
    starts = {(one.lineno, one.col_offset) for one in found}
    tokens, lines, depth = 0, set[int](), 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in LAYOUT or (token.type == tokenize.STRING and token.start in starts):
            continue
        lines.update(range(token.start[0], token.end[0] + 1))
        tokens += depth == 0
        depth += (token.type == FSTRING_START) - (token.type == FSTRING_END)
    docs = {line for one in found for line in range(one.lineno, (one.end_lineno or one.lineno) + 1)}
    return Counter(files=1, tokens=tokens, code=len(lines), docs=len(docs))


def folder_figures(folder: Path) -> Counter[str]:
    """The same of all files in a folder."""
    total: Counter[str] = Counter()
    for path in sorted(folder.rglob("*.py")):
        total += source_figures(path.read_text(encoding="utf-8"))
    return total


def functions(folder: Path) -> tuple[list[Function], list[Function]]:
    """All functions and methods, and those at the top of a module."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.py"))]
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
    every = [node for tree in trees for node in ast.walk(tree) if isinstance(node, kinds)]
    return every, [node for tree in trees for node in tree.body if isinstance(node, kinds)]


def num_parameters(function: Function) -> int:
    """Parameters without self and cls."""
    names = [one.arg for one in (*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs)]
    return len(names) - (names[:1] in (["self"], ["cls"]))


def regex_strings(folder: Path) -> tuple[int, int]:
    """Strings that only a regular expression would hold, in the sources of a folder and in its tables."""
    texts: list[str] = []
    for path in sorted(folder.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        docs = {id(one.value) for one in docstrings(tree)}
        texts += [text for node in ast.walk(tree) if isinstance(text := _constant(node), str) and id(node) not in docs]
    tables = [_strings(tomllib.loads(path.read_text(encoding="utf-8"))) for path in sorted(folder.rglob("*.toml"))]
    held = [text for table in tables for text in table]
    return sum(map(bool, map(REGEX.search, texts))), sum(map(bool, map(REGEX.search, held)))


def _strings(value: Any) -> list[str]:
    if isinstance(value, dict):
        return [text for key, part in value.items() for text in (key, *_strings(part))]
    if isinstance(value, list):
        return [text for part in value for text in _strings(part)]
    return [value] if isinstance(value, str) else []


def layers(root: Path) -> int:
    """Lines of the layered import contract."""
    table = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    return sum(len(one.get("layers", ())) for one in table["contracts"])


def option_names(root: Path) -> set[str]:
    """Names of long options of all commands, as they are printed."""

    def printed(*words: str) -> str:
        environment = os.environ | {"PYTHONPATH": str((root / "src").resolve()), "COLUMNS": "200"}
        command = [sys.executable, "-m", "mmweaver", *words]
        return subprocess.run(command, capture_output=True, text=True, env=environment, check=False).stdout

    commands = re.findall(r"^ {2,6}([a-z]+)(?:  +\S|$)", printed("--help"), re.MULTILINE)
    pages = [printed("--help"), *(printed(name, "--help-all") or printed(name, "--help") for name in commands)]
    return {name for page in pages for name in re.findall(r"^ +(?:-\w[^-]*, )?(--[a-z][a-z0-9-]*)", page, re.MULTILINE)}


def num_words(*paths: Path) -> int:
    return sum(len(path.read_text(encoding="utf-8").split()) for path in paths)


def measure(root: Path) -> dict[str, Any]:
    """All figures by name."""
    package = root / PACKAGE
    whole, language = folder_figures(package), folder_figures(root / LANGUAGE)
    every, top = functions(package)
    by_preposition = [one for one in top if one.name.strip("_").split("_")[0] in PREPOSITIONS]
    folders = [one for one in sorted(package.iterdir()) if any(one.rglob("*.py"))]
    decisions = [one for one in (root / "docs" / "decisions").rglob("*.md") if one.name != "README.md"]
    pages = [one for one in (root / "docs").rglob("*.md") if "decisions" not in one.parts]
    studies = list((root / "studies").rglob("*.py"))
    loose = [one for one in package.glob("*.py") if one.name != "__init__.py"]
    options = option_names(root)
    in_sources, in_tables = regex_strings(root / LANGUAGE)
    figures: dict[str, Any] = {
        "tokens in src": whole["tokens"],
        "tokens per line of code": round(whole["tokens"] / whole["code"], 2),
        "lines of code in src": whole["code"],
        "files in src": whole["files"],
        "packages at the top": len(folders),
        "packages in all": sum(any(one.glob("*.py")) for one in package.rglob("*") if one.is_dir()),
        "loose modules at the top": len(loose),
        "layers of the import contract": layers(root),
        "language: lines of code": language["code"],
        "language: regex strings in sources": in_sources,
        "language: regex strings in tables": in_tables,
        "tests: lines of code": folder_figures(root / "tests")["code"],
        "functions with more than 8 parameters": sum(num_parameters(one) > MAX_PARAMETERS for one in every),
        "functions named by a preposition": len(by_preposition),
        "of all functions of modules, %": round(100 * len(by_preposition) / max(len(top), 1), 1),
        "docstring lines per line of code": round(whole["docs"] / whole["code"], 2),
        "fmt: skip in src": sum(one.read_text(encoding="utf-8").count("# fmt: skip") for one in package.rglob("*.py")),
        "decisions": len(decisions),
        "decisions: words, with their list": num_words(*(root / "docs" / "decisions").rglob("*.md")),
        "CHANGELOG: words": num_words(root / "CHANGELOG.md"),
        "docs: words without decisions": num_words(*pages),
        "README: lines": len((root / "README.md").read_text(encoding="utf-8").splitlines()),
        "studies: lines": sum(len(one.read_text(encoding="utf-8").splitlines()) for one in studies),
        "option names of the command line": len(options),
    }
    parts = {one.name: folder_figures(one)["tokens"] for one in folders}
    parts |= {one.name: source_figures(one.read_text(encoding="utf-8"))["tokens"] for one in loose}
    for part in (LANGUAGE, PACKAGE / "motion" / "animation", PACKAGE / "scene" / "procedural"):
        if (root / part).is_dir():
            parts[str(part.relative_to(PACKAGE))] = folder_figures(root / part)["tokens"]
    figures["tokens by part"] = dict(sorted(parts.items(), key=lambda item: -item[1]))
    figures["options"] = sorted(options)
    return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).resolve().parents[1])
    parser.add_argument("--json", action="store_true", help="print all figures as JSON, names of options too")
    options = parser.parse_args()
    figures = measure(options.folder)
    if options.json:
        print(json.dumps(figures, indent=1))
        return
    for name, value in figures.items():
        if not isinstance(value, dict | list):
            print(f"{name:42} {value:>12,}")
    for name, tokens in figures["tokens by part"].items():
        print(f"  {name:40} {tokens:>12,}")


if __name__ == "__main__":
    main()
