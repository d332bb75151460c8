"""What a study is, and where the studies are found."""

import argparse
import ast
import importlib
from functools import cache
from pathlib import Path
from typing import Any, Protocol, cast, runtime_checkable

from mmweaver.core.errors import InputError
from studies.manifest import StudyRun

FOLDER = Path(__file__).resolve().parent


@runtime_checkable
class Study(Protocol):
    """A module of studies/<topic>/ that answers one question.

    The module is the study: its docstring says what is asked and how it is measured, its name is the name given to
    `python -m studies run`.
    """

    __doc__: str | None

    @staticmethod
    def add_options(parser: argparse.ArgumentParser) -> None:
        """Declares the options of this study alone."""
        ...

    @staticmethod
    def run_study(options: argparse.Namespace, run: StudyRun) -> None:
        """Measures, and writes results by `run.write`."""
        ...


class Reads(argparse.Action):
    """An option that names files or folders which the study reads: their sha256 goes into the manifest."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        setattr(namespace, self.dest, values)


def inputs_of(parser: argparse.ArgumentParser, options: argparse.Namespace) -> list[Path]:
    """Files and folders that a study reads, by its `Reads` options."""
    values = [getattr(options, action.dest) for action in parser._actions if isinstance(action, Reads)]
    paths = [path for value in values for path in (value if isinstance(value, list) else [value]) if path is not None]
    return list(dict.fromkeys(paths))


@cache
def study_files() -> dict[str, Path]:
    """{name: file} of every study, found without importing any."""
    return {file.stem: file for file in sorted(FOLDER.glob("*/*.py")) if _is_study(file)}


def _is_study(file: Path) -> bool:
    functions = {node.name for node in ast.parse(file.read_text("utf-8")).body if isinstance(node, ast.FunctionDef)}
    return {"add_options", "run_study"} <= functions


def question_of(file: Path) -> str:
    """The first line of a study's docstring."""
    return (ast.get_docstring(ast.parse(file.read_text("utf-8"))) or "").partition("\n")[0]


def load_study(name: str) -> Study:
    """Imports a study. Raises InputError for an unknown name, and where a package that it needs is not installed."""
    files = study_files()
    if name not in files:
        raise InputError(f"no study is called {name!r}; python -m studies list names all {len(files)}")
    try:
        module = importlib.import_module(f"studies.{files[name].parent.name}.{name}")
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] in ("studies", "mmweaver"):
            raise
        raise InputError(f"study {name} needs the package {error.name}: pip install {error.name}") from error
    return cast("Study", module)
