"""The runner of all studies: python -m studies run NAME, list, tables, check."""

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from studies.manifest import StudyRun, rows_sha256
from studies.schema import check_record
from studies.study import inputs_of, load_study, question_of, study_files

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "results"
BAD_INPUT = 2


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit status: 0, 1 where a check fails, 2 for bad input."""
    words = sys.argv[1:] if argv is None else list(argv)
    parser = argparse.ArgumentParser(prog="python -m studies", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("run", help="run a study", add_help=False)
    one.add_argument("name", help="a name that `list` prints; NAME --help shows the options of the study")
    one.add_argument("options", nargs=argparse.REMAINDER)
    commands.add_parser("list", help="name every study and its question")
    tables = commands.add_parser("tables", help="fill the tables and scores of README, docs and model cards")
    tables.add_argument("--results", type=Path, default=RESULTS)
    tables.add_argument("pages", type=Path, nargs="*", help="pages to fill (default: all that have tables)")
    check = commands.add_parser("check", help="check results against the schema, and tables against the results")
    check.add_argument("--results", type=Path, default=RESULTS)
    try:
        if words[:1] == ["run"] and words[1:2] not in ([], ["-h"], ["--help"]):
            run_named(words[1], words[2:])
            return 0
        given = parser.parse_args(words)
        if given.command == "list":
            list_studies()
        elif given.command == "tables":
            fill_tables(given.pages, given.results)
        elif given.command == "check":
            return check_all(given.results)
        else:
            one.print_help()
            return BAD_INPUT
    except InputError as error:
        print(f"studies: error: {error}", file=sys.stderr)
        return BAD_INPUT
    return 0


def run_named(name: str, words: Sequence[str]) -> list[Path]:
    """Runs a study with options of its own; returns the results that it wrote. Raises InputError."""
    threads = _threads(words)
    study = load_study(name)
    parser = argparse.ArgumentParser(
        prog=f"python -m studies run {name}", description=study.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--results", type=Path, default=RESULTS, help="folder of results (default: that of the clone)")
    parser.add_argument("--threads", type=int, default=1, help="threads of numpy and torch (default 1)")
    study.add_options(parser)
    options = parser.parse_args(list(words))
    inputs = inputs_of(parser, options)
    missing = [path for path in inputs if not path.exists()]
    if missing:
        raise InputError(f"{missing[0]} does not exist")
    run = StudyRun(name, options.results, inputs=inputs, options=_as_json(vars(options)))
    torch: Any = sys.modules.get("torch")
    if torch is not None:
        torch.set_num_threads(threads)
    study.run_study(options, run)
    for path in run.written:
        print(path)
    return run.written


def _threads(words: Sequence[str]) -> int:
    """What --threads says; BLAS reads its number of threads when it is imported, so this comes first."""
    early = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    early.add_argument("--threads", type=int, default=1)
    threads: int = early.parse_known_args(list(words))[0].threads
    if threads < 1:
        raise InputError(f"--threads must be 1 or more, not {threads}")
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[variable] = str(threads)
    return threads


def _as_json(options: dict[str, Any]) -> dict[str, Any]:
    """Options as JSON values; of a path the last part alone, for folders differ between machines."""
    return json.loads(json.dumps(options, default=lambda value: value.name if isinstance(value, Path) else str(value)))


def list_studies() -> None:
    """Prints name and question of every study, topic by topic."""
    topic = ""
    for name, file in sorted(study_files().items(), key=lambda pair: (pair[1].parent.name, pair[0])):
        if file.parent.name != topic:
            topic = file.parent.name
            print(f"{topic}:")
        print(f"  {name:24} {question_of(file)}")


def fill_tables(pages: Sequence[Path], results: Path) -> None:
    """Fills the marked tables of pages. Raises InputError for unknown tables."""
    from studies.report.pages import fill, pages_of

    for page in pages or pages_of(ROOT):
        if fill(page, results):
            print(f"{page}: filled anew")


def check_all(results: Path) -> int:
    """Prints what is wrong with results and tables; returns the exit status."""
    from studies.report.pages import filled_page, pages_of

    wrong = [line for path in sorted(results.glob("*/**/*.json")) for line in check_result(path, results)]
    for page in pages_of(ROOT):
        if filled_page(page, results) != page.read_text(encoding="utf-8"):
            wrong.append(f"{page.relative_to(ROOT)}: a table or score is stale; run python -m studies tables")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


def check_result(path: Path, results: Path) -> list[str]:
    """What is wrong with a result file; files without rows hold data of a study, not results."""
    record = json.loads(path.read_text(encoding="utf-8"))
    name = path.relative_to(results).as_posix()
    if "rows" not in record:
        return []
    try:
        check_record(record, name)
    except InputError as error:
        return [str(error)]
    outputs = {output["name"]: output for output in record["manifest"]["outputs"]}
    if outputs.get(name, {}).get("rows_sha256") != rows_sha256(record["rows"]):
        return [f"{name}: its rows differ from those that the study wrote (rows_sha256)"]
    return []
