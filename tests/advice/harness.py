"""A command that is refused or warned of, what its message advises, and the command again with that advice carried out.

The advice is taken from what was printed: options with the values that stand there, commands as they stand there. Only
a placeholder (DIR, KIND=X,Y) gets a value here.
"""

import io
import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from mmweaver.cli.main import main
from tests.advice.templates import Template, templates

Words = list[str]
# Command and message -> the commands that the message advises, in order; one that a command prints itself is a function
# of what that has printed.
Step = Words | Callable[[str], Words]
Try = Callable[[Words, str], Sequence[Step]]
_VALUE = r"[ =](?P<value>'[^']*'|[^\s;)]+)"
_PLACEHOLDER = re.compile(r"[A-Z][A-Z_]*")
_PLAIN_WORD = re.compile(r"[a-z]+")


@dataclass(frozen=True)
class Row:
    """One text of the source, a command that prints it, and what it advises, each alternative tried by itself."""

    text: str  # a part that no other text of the source has
    command: str  # {name}: one of the made inputs
    tries: tuple[Try, ...]
    before: Callable[[], object] = lambda: None  # makes files in the working folder
    reads_photo: bool = False  # else the room is the sample room, whatever photo is named

    @property
    def template(self) -> Template:
        """The text of the source."""
        found = [one for one in templates() if self.text == one.text]
        found = found or [one for one in templates() if self.text in one.text]
        assert len({one.text for one in found}) == 1, f"{self.text!r} is part of {len(found)} texts"
        return found[0]


def add(option: str, value: str | None = None, *more: str) -> Try:
    """The option is added, or its value replaced, as the message prints it; `value` fills a placeholder or nothing."""

    def changed(words: Words, message: str) -> list[Step]:
        own = printed_value(option, message)
        given = own if value is None else value
        if own is not None and value is not None:
            pattern = "".join("[^,]+" if k % 2 else re.escape(part) for k, part in enumerate(_split(own)))
            assert _PLAIN_WORD.fullmatch(own) or re.fullmatch(pattern, value), f"{message}: advised {own}, not {value}"
        return [[*without(words, option), option, *([] if given is None else [given]), *more]]

    return changed


def _split(text: str) -> list[str]:
    """What is printed literally and placeholders, in turn."""
    return re.split(f"({_PLACEHOLDER.pattern})", text)


def printed_value(option: str, message: str) -> str | None:
    """What follows an option in a message, if anything does."""
    assert re.search(rf"(?<![\w-]){option}(?![\w-])", message), f"{option} is not advised: {message}"
    found = re.search(rf"(?<![\w-]){option}{_VALUE}", message)
    return None if found is None else found["value"].strip("'").rstrip(".,:?")


def flag(option: str) -> Try:
    """An option without a value is added."""

    def changed(words: Words, message: str) -> list[Step]:
        printed_value(option, message)
        return [[*words, option]]

    return changed


def drop(*options: str) -> Try:
    """What the message advises to leave out is left out."""

    def changed(words: Words, message: str) -> list[Step]:
        assert re.search("leave|without|omit|is no option|is for|are for|is of|not both|once", message)
        for option in options:
            assert option in message, f"{option} is not advised to be left out: {message}"
            words = without(words, option)
        return [words]

    return changed


def both(one: Try, other: Try) -> Try:
    """One advice and another at once."""

    def changed(words: Words, message: str) -> list[Step]:
        (step,) = one(words, message)
        assert not callable(step)
        return [*other(step, message)]

    return changed


def instead(said: str, old: str, new: str = "") -> Try:
    """Consecutive words of the command are replaced by others or none, as the message advises by words of its own."""

    def changed(words: Words, message: str) -> list[Step]:
        assert said in message, f"{said!r} is not advised: {message}"
        replaced, theirs = shlex.split(old), shlex.split(new)
        at = max(k for k in range(len(words)) if words[k : k + len(replaced)] == replaced)
        return [[*words[:at], *theirs, *words[at + len(replaced) :]]]

    return changed


def plus(said: str, *more: str) -> Try:
    """Words are added to the command, as the message advises by words of its own."""

    def changed(words: Words, message: str) -> list[Step]:
        assert said in message, f"{said!r} is not advised: {message}"
        return [[*words, *more]]

    return changed


def first(command: str, then: Try | None = None, **placeholders: str) -> Try:
    """The command that the message prints, from these words on, is run; then the refused one again, or changed.

    What it prints goes into the file behind a ">", if one is printed.
    """

    def changed(words: Words, message: str) -> list[Step]:
        found = re.search(re.escape(command) + r"[^;,()`']*", message)
        assert found, f"{command!r} is not advised: {message}"
        printed = [placeholders.get(word, word) for word in shlex.split(found[0].strip().rstrip("."))]
        assert printed[0] == "mmweaver"
        return [printed[1:], *(then(words, message) if then else [words])]

    return changed


def printed(start: str, *then: Words) -> Try:
    """The command that the message (or what was run last) prints after these words, then others."""

    def changed(words: Words, message: str) -> list[Step]:
        return [_command(start, message), *(then or [words])]

    return changed


def _command(start: str, text: str) -> Words:
    found = re.search(re.escape(start) + r"(mmweaver [^;()]*?)(?:$|[;()]| or |, )", text, re.MULTILINE)
    assert found, f"no command is advised: {text}"
    return shlex.split(found[1])[1:]


def repaired(said: str) -> Try:
    """`mmweaver verify` is run as the message prints it, then what that prints, then the refused command again."""

    def changed(words: Words, message: str) -> list[Step]:
        assert said in message, f"{said!r} is not advised: {message}"
        found = re.search(r"mmweaver (verify) ([^\s;()]+)", message)
        return [list(found.groups()) if found else [], _made_anew, words]

    return changed


def _made_anew(printed: str) -> Words:
    return _command("make it anew with: ", printed)


def edit(said: str, edited: Callable[[], object], then: Try | None = None) -> Try:
    """Files are changed as the message advises by these words; then the refused command runs again, or changed."""

    def changed(words: Words, message: str) -> list[Step]:
        assert said in message, f"{said!r} is not advised: {message}"
        edited()
        return [*then(words, message)] if then else [words]

    return changed


def without(words: Words, option: str) -> Words:
    """The command without an option and its values."""
    kept, skipping = [], False
    for word in words:
        if word == option or word.startswith("--"):
            skipping = word == option
        if not skipping:
            kept.append(word)
    return kept


def _filled(words: Words, inputs: dict[str, Any]) -> Words:
    return [re.sub(r"\{(\w+)\}", lambda name: str(inputs[name[1]]), word) for word in words]


def run(words: Words, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit status and everything printed."""
    words, _, file = (words[: words.index(">")], ">", words[-1]) if ">" in words else (words, "", "")
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("sys.stdin", io.StringIO("a person waves\n"))
            status = main(words)
    except SystemExit as ended:  # what argparse refuses
        status = int(ended.code or 0)
    printed = capsys.readouterr()
    if file:
        Path(file).write_text(printed.out)
    return status, f"{printed.out}\n{printed.err}"


def said(template: Template, printed: str) -> str:
    """The printed line that holds a text, "" for none."""
    return next((line for line in printed.splitlines() if template.is_in(line)), "")


def carry_out(row: Row, inputs: dict[str, Any], capsys: pytest.CaptureFixture[str], folders: Path) -> None:
    """Provokes the message of a row, and tries each of its advices in a folder of its own."""
    for number, advice in enumerate(row.tries):
        with pytest.MonkeyPatch.context() as patch:
            folder = folders / str(number)
            folder.mkdir()
            patch.chdir(folder)
            row.before()
            words = shlex.split(row.command)
            status, printed = run(_filled(words, inputs), capsys)
            message = said(row.template, printed)
            assert message, f"not provoked: {printed}"
            steps = advice(words, message)
            for step in steps:
                again = step(printed) if callable(step) else step
                status, printed = run(_filled(again, inputs), capsys)
                reports_damage = again[0] == "verify" and step is not steps[-1]
                assert status == reports_damage, f"{message}\n-> {shlex.join(again)}\n{printed}"
            assert not said(row.template, printed), f"{message}\n-> {shlex.join(again)}\n{printed}"
