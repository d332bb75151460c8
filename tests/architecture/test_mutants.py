"""make mutants: a broken line that a test holds is noticed, one that no test looks at is not."""

import os
from pathlib import Path

import pytest

from tools.mutants import copies
from tools.mutants.mutations import changes_the_program, mutations
from tools.mutants.places import PACKAGE, PARTS, Place, sampled_places
from tools.mutants.trials import Trials

ROOT = Path(__file__).resolve().parents[2]
TOY = b'''"""A docstring - of 3 words."""

LIMIT_M: float = 5.0


def ahead(value_m: float) -> float:
    if value_m > LIMIT_M:
        raise ValueError(f"{value_m} m are more than {LIMIT_M} m")
    return value_m - 0.5


def unseen(value_m: float) -> float:
    return sorted([value_m + 7.0])[0]
'''
TESTS = """
import pytest
from toy import ahead, unseen

def test_ahead():
    assert ahead(2.0) == 1.5
    with pytest.raises(ValueError):
        ahead(6.0)

def test_unseen():
    unseen(1.0)
"""
FORKS = pytest.mark.skipif(os.name == "nt", reason="forks")


class _BothTests:
    state = "one"

    def tests(self, place: Place) -> set[str]:
        return set(self.in_order(place))

    def in_order(self, place: Place) -> list[str]:
        return ["tests/test_toy.py::test_ahead", "tests/test_toy.py::test_unseen"]

    def spent_s(self, name: str) -> float:
        return 0.1


@pytest.fixture(autouse=True)
def nothing_is_preloaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(copies, "PRELOADED", [])


def _toy_verdict(folder: Path, line: int, kind: str) -> dict[str, object]:
    (folder / "tests").mkdir(parents=True)
    (folder / "src").mkdir()
    (folder / "src" / "toy.py").write_bytes(TOY)
    (folder / "tests" / "test_toy.py").write_text(TESTS)
    (folder / "pytest.ini").write_text("[pytest]\n")
    mutation = next(one for one in mutations(TOY) if (one.line, one.kind) == (line, kind))
    trials = Trials(folder, _BothTests(), folder.parent / "log.jsonl")
    verdict = trials.verdict(Place("core", "src/toy.py", mutation))
    assert (folder / "src" / "toy.py").read_bytes() == TOY
    assert Trials(folder, _BothTests(), folder.parent / "log.jsonl").verdicts == trials.verdicts
    return verdict


@FORKS
def test_what_a_test_holds_is_noticed(tmp_path: Path):
    assert _toy_verdict(tmp_path / "copy", 9, "sign")["noticed_by"] == "tests/test_toy.py::test_ahead"


@FORKS
def test_what_no_test_looks_at_survives_until_tests_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    assert _toy_verdict(tmp_path / "copy", 13, "sign")["noticed_by"] is None
    monkeypatch.setattr(_BothTests, "state", "another")
    assert not Trials(tmp_path / "copy", _BothTests(), tmp_path / "log.jsonl").verdicts


def test_kinds_of_mutations():
    found = {(one.line, one.kind, one.after) for one in mutations(TOY)}
    assert found >= {
        (3, "constant", "(5.0 * 1000)"), (7, "comparison", "<="), (8, "guard", "pass"), (9, "sign", "+"),
        (8, "message", 'f"{LIMIT_M} m are more than {value_m} m"'), (13, "order", "sorted([value_m + 7.0])[::-1]"),
    }  # fmt: skip
    assert not [one for one in found if one[0] in (1, 6, 12)]  # docstring, annotations


@pytest.mark.parametrize(
    ("source", "after"),
    [
        ("a = (b + c) @ d\n", "a = (d) @ (b + c)\n"),
        ("a = (b  # one - two\n     - c)\n", "a = (b  # one - two\n     + c)\n"),
        ("é = 'é'; a = -b\n", "é = 'é'; a = (b)\n"),
        ("rng = stream(seed, 'noise')\n", "rng = stream(0, 'noise')\n"),
        ("f(left_m, right_m)\n", "f(right_m, left_m)\n"),
        ("os.fsync(handle)\n", "pass\n"),
    ],
)
def test_mutations_change_what_they_say(source: str, after: str):
    assert after in [one.apply(source.encode()).decode() for one in mutations(source.encode())]


def test_the_sample_follows_from_the_seed(monkeypatch: pytest.MonkeyPatch):
    """One line at most once, and each compiles to another program; every part has files."""
    monkeypatch.setattr("tools.mutants.places.PARTS", {name: PARTS[name] for name in ("recordings", "results")})
    places = sampled_places(ROOT, 3, 20)
    assert places == sampled_places(ROOT, 3, 20) != sampled_places(ROOT, 4, 20)
    assert len({(place.file, place.mutation.line) for place in places}) == 20
    for place in places:
        assert changes_the_program((ROOT / place.file).read_bytes(), place.mutation)
    for part in PARTS.values():
        assert all((ROOT / PACKAGE / folder).exists() for folder in part.folders)
        assert all((ROOT / "docs" / f"{page}.md").is_file() for page in part.pages)
