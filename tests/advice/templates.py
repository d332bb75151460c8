"""Every text in the source that names an option or a command of ours to the user, found in the syntax tree."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "src" / "mmweaver"
ONLY_A_NAME = re.compile(r"-?-[a-z\N{WHITE SQUARE}-]+=?([a-z\N{WHITE SQUARE}]+=?)?|mmweaver [a-z ]+")
# Declarations of options, whose texts are shown by --help alone; examples of the help are run by tests of the README.
DECLARES = {"add_argument", "add_parser", "add_argument_group", "Parser", "Rare", "shown", "option"}
HELP = {"EXAMPLES", "USAGE", "DESCRIPTION", "COMMANDS", "RENAMED"}
GAP = "\N{WHITE SQUARE}"  # stands for a value in a text
NAMES = re.compile(rf"(?<![\w-])--[a-z{GAP}]|\bmmweaver (?:[a-z]|--)")


@dataclass(frozen=True)
class Template:
    """A text with gaps for values."""

    file: str  # below src/mmweaver
    line: int
    text: str

    def is_in(self, message: str) -> bool:
        """Whether a printed line holds this text, with any values."""
        parts = [re.escape(" ".join(part.split())) for part in re.split(rf"{GAP}|{{\w+}}", self.text)]
        return re.search(r"\s*.*?\s*".join(parts), " ".join(message.split())) is not None


@cache
def templates() -> tuple[Template, ...]:
    """All of them, in the order of files and lines."""
    found = [one for path in sorted(SOURCE.rglob("*.py")) for one in _of_file(path)]
    return tuple(sorted(found, key=lambda one: (one.file, one.line)))


def _of_file(path: Path) -> Iterator[Template]:
    for node in _messages(ast.parse(path.read_text())):
        text = _text(node)
        if NAMES.search(text) and not ONLY_A_NAME.fullmatch(text.strip()):
            yield Template(file=path.relative_to(SOURCE).as_posix(), line=node.lineno, text=text)


def _messages(node: ast.AST) -> Iterator[ast.Constant | ast.JoinedStr]:
    """The texts below a node, outermost first, without docstrings and declarations of options."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    if isinstance(node, ast.Call) and _name(node.func) in DECLARES:
        return
    if isinstance(node, ast.Assign) and any(_name(target) in HELP for target in node.targets):
        return
    if isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str)):
        yield node
        return
    for child in ast.iter_child_nodes(node):
        yield from _messages(child)


def _name(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _text(node: ast.expr) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(_text(part) for part in node.values)
    return str(node.value) if isinstance(node, ast.Constant) else GAP
