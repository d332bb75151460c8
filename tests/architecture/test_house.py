"""The house rules that no linter knows."""

import ast
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.presets import AWR1843
from mmweaver.core.records import AdcCube

ROOT = Path(__file__).resolve().parents[2]
SOURCES = sorted((ROOT / "src" / "mmweaver").rglob("*.py"))
VAGUE = {"utils", "util", "helpers", "misc", "common", "base"}


def test_every_test_file_mirrors_a_source_file():
    """tests/dsp/test_cfar.py stands for src/mmweaver/dsp/cfar.py; physics, architecture and real data stand apart."""
    apart = {"physics", "architecture", "real"}
    for test in sorted((ROOT / "tests").rglob("test_*.py")):
        place = test.relative_to(ROOT / "tests")
        if place.parts[0] in apart:
            continue
        mirrored = ROOT / "src" / "mmweaver" / place.parent / place.name.removeprefix("test_")
        assert mirrored.is_file(), f"{place} mirrors no source file"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT / "src")))
def test_sizes_and_names(path: Path):
    text = path.read_text()
    assert len(text.splitlines()) <= 500, "split this file"
    assert path.stem not in VAGUE, "say what is in it"
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            length = (node.end_lineno or node.lineno) - node.lineno + 1
            assert length <= 80, f"{node.name} has {length} lines"
            names = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
            assert "range" not in names, f"{node.name} shadows range"


def test_shapes_are_checked_in_tests():
    """The canary: were the jaxtyping hook off, a wrong shape would pass."""
    with pytest.raises(Exception, match="samples"):
        AdcCube(samples=np.zeros((2, 3), np.complex64), config=AWR1843, scale=1.0)


def test_no_pickle_is_loaded():
    for path in SOURCES:
        text = path.read_text()
        assert "import pickle" not in text, path
        assert "allow_pickle=True" not in text, path
