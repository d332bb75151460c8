"""The house rules that no linter knows."""

import ast
from pathlib import Path

import jaxtyping
import numpy as np
import pytest
from beartype import beartype
from jaxtyping import Float32, TypeCheckError
from threadpoolctl import threadpool_info

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from tests.shape_checks import FIRST_CALLS, next_file

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = sorted((ROOT / "src" / "mmweaver").rglob("*.py"))
SOURCES = [*PACKAGE, *sorted((ROOT / "studies").rglob("*.py"))]
VAGUE = {"utils", "util", "helpers", "misc", "common", "base"}


def test_functions_and_names():
    for path in SOURCES:
        text = path.read_text()
        assert path.stem not in VAGUE, f"say what is in {path}"
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef):
                names = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
                assert "range" not in names, f"{path}: {node.name} shadows range"


def test_shapes_are_checked_in_tests():
    """The canary: were the jaxtyping hook off, a wrong shape would pass."""
    with pytest.raises(Exception, match="samples"):
        AdcCube(samples=np.zeros((2, 3), np.complex64), config=AWR1843, scale=1.0)


def test_shapes_are_checked_in_the_first_calls_of_every_file():
    """In inner loops only those: see tests/shape_checks.py."""
    calls: list[object] = []

    def kept(values: Float32[np.ndarray, "row 3"]) -> None:
        calls.append(values)

    check = jaxtyping.jaxtyped(kept, typechecker=beartype)
    for _ in range(2):
        next_file()
        with pytest.raises(TypeCheckError):
            check(np.zeros((3, 2), np.float32))
        for _ in range(2 * FIRST_CALLS):
            check(np.zeros((2, 3), np.float32))
    assert len(calls) == 4 * FIRST_CALLS


def test_tests_run_on_one_thread():
    assert {library["num_threads"] for library in threadpool_info()} == {1}


OPENERS = {
    "np.load", "np.fromfile", "np.memmap", "np.loadtxt", "np.genfromtxt", "Image.open", "json.load", "json.loads",
    "tomllib.load", "tomllib.loads", "zipfile.ZipFile", "torch.load", "safe_open", "load_file",
}  # fmt: skip
READ_METHODS = {"read_text", "read_bytes"}
ZARR_METHODS = {"open_group", "open_array", "open_consolidated"}  # writers say mode="w" or "a"
# Writers, which open what they make, and files of the system.
NOT_READERS = {"io/npz_files.py", "core/atomic_files.py", "core/staging.py"}


def test_files_are_opened_by_the_safe_files_alone():
    """Budgets, regular files, one-line errors: core/safe_files; no reader may open a file in another way."""
    found = []
    for path in PACKAGE:
        name = path.relative_to(ROOT / "src" / "mmweaver").as_posix()
        if name.startswith("core/safe_files/") or name in NOT_READERS:
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call):
                called = ast.unparse(node.func)
                is_method = isinstance(node.func, ast.Attribute) and node.func.attr in READ_METHODS
                opens = called.endswith(".open") or called == "open"
                is_read = opens and any(isinstance(a, ast.Constant) and str(a.value).startswith("r") for a in node.args)
                if called in OPENERS or is_method or _reads_zarr(node) or (is_read and called != "av.open"):
                    found.append(f"{name}:{node.lineno} {called}")
    assert not found, f"open these through mmweaver.core.safe_files: {found}"


def _reads_zarr(call: ast.Call) -> bool:
    modes = {ast.unparse(word.value).strip("'") for word in call.keywords if word.arg == "mode"}
    return isinstance(call.func, ast.Attribute) and call.func.attr in ZARR_METHODS and not modes & {"w", "a"}


def test_no_pickle_is_loaded():
    for path in SOURCES:
        text = path.read_text()
        assert "import pickle" not in text, path
        assert "allow_pickle=True" not in text, path
