"""What README and tutorials tell a reader to type: commands and Python, in the order of the page."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from tests.artifact.artifact import ROOT

PAGE = ROOT / "README.md"
TUTORIALS = sorted((ROOT / "docs" / "start").glob("*.md"))
INSTALLING = ("pip", "git", "make", "python", "cd")  # of the package itself: there is a test of its own for that
SHELLS = ("", "bash", "sh", "shell", "console")
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```|((?:^    [^\n]*\n)+)", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Recipe:
    """A line of shell, or a block of Python."""

    text: str
    is_python: bool = False

    @property
    def commands(self) -> list[list[str]]:
        """The words of each command of a line of shell; of Python none."""
        if self.is_python:
            return []
        lexer = shlex.shlex(self.text, posix=True, punctuation_chars="&")
        lexer.whitespace_split = True
        commands: list[list[str]] = [[]]
        for word in lexer:
            if word == "&&":
                commands.append([])
            else:
                commands[-1].append(word)
        return commands


def recipes(page: Path = PAGE) -> list[Recipe]:
    """All recipes of a page; lines that install the package itself are left out."""
    found = []
    for language, fenced, indented in _BLOCK.findall(page.read_text(encoding="utf-8")):
        if language == "python":
            found.append(Recipe(fenced, is_python=True))
        elif indented or language in SHELLS:
            text = re.sub(r"^    ", "", indented or fenced, flags=re.MULTILINE).replace("\\\n", " ")
            lines = [Recipe(line) for line in text.splitlines() if line.split("#")[0].strip()]
            found += [line for line in lines if "mmweaver" in [words[0] for words in line.commands]]
            others = [line.text for line in lines if line.commands[0][0] not in ("mmweaver", *INSTALLING)]
            assert not others, f"no recipe of mmweaver: {others}"
    return found


def extras_of_the_readme() -> list[str]:
    """The extras that the page tells a reader to install."""
    named = re.findall(r"pip install 'mmweaver\[([\w,]+)\]'", PAGE.read_text(encoding="utf-8"))
    return sorted({extra for group in named for extra in group.split(",")})
