"""Every study has the same doors, and is found without being imported."""

import argparse
import subprocess
import sys
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.study import FOLDER, Reads, Study, inputs_of, load_study, question_of, study_files

ROOT = Path(__file__).resolve().parents[2]


def test_every_study_asks_a_question():
    files = study_files()
    assert len(files) > 20
    for name, file in files.items():
        assert len(question_of(file)) > 20, f"{name} needs a first line that says what it asks"
    assert isinstance(load_study("codec_cuts"), Study)


@pytest.mark.slow  # its functions are found by their names in the test above; here all are imported
@pytest.mark.parametrize("name", study_files())
def test_a_study_follows_the_protocol(name: str):
    try:
        assert isinstance(load_study(name), Study)
    except InputError as error:
        if "needs the package" not in str(error):
            raise
        pytest.skip(str(error))


def test_no_module_is_run_by_itself():
    for file in FOLDER.rglob("*.py"):
        assert "if __name__" not in file.read_text(), f"{file}: run it by python -m studies run"


def test_results_are_made_by_studies_that_exist():
    from studies.schema import read_record

    known = set(study_files()) | {f"benchmarks/{file.stem}" for file in (ROOT / "benchmarks").glob("*.py")}
    for path in sorted((ROOT / "results").glob("*/**/*.json")):
        if "judgements" not in path.name:
            assert read_record(path)["study"] in known, path


def test_unknown_studies_are_one_line():
    with pytest.raises(InputError, match="no_such_study"):
        load_study("no_such_study")


def test_listing_imports_neither_torch_nor_the_studies():
    code = "import sys, studies.run; studies.run.main(['list']); print('torch' in sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "False"
    assert "codecs" in done.stdout


def test_inputs_are_the_paths_that_are_read():
    parser = argparse.ArgumentParser()
    parser.add_argument("--data", type=Path, action=Reads, default=Path("usual"))
    parser.add_argument("--weights", type=Path, action=Reads)
    parser.add_argument("--caches", type=Path, action=Reads, nargs="*")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args(["--caches", "a", "b", "--out", "c"])
    assert inputs_of(parser, options) == [Path("usual"), Path("a"), Path("b")]
