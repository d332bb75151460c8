"""Promises of sentences in the bundled room, measured on joints by code that shares nothing with the generator."""

import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from mmweaver.weaver.front_door import Weaver

TOOLS = Path(__file__).parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
promises = pytest.importorskip("promises")
TABLE = tomllib.loads((TOOLS / "promises.toml").read_text(encoding="utf-8"))
CHECKS = {text: checks for sentences in TABLE.values() for text, checks in sentences.items()}
WEAVER = Weaver("physics")
KEPT = (
    "a person walks 2 m away from the radar",
    "a person walks two metres backwards",
    "a person walks one metre forward",
    "a person walks 6 feet towards the radar",
    "a person walks at 100 steps per minute",
    "a person walks away from the radar at 0.8 m/s",
    "a person turns 45 degrees to the right",
    "a person stands sideways to the radar",
    "a person stands next to the table and wipes it",
    "a person sits down at the table",
    "a person squats three times",
    "a person waves with the left hand",
    "a person falls backwards",
)
NOT_THERE = ("a person sits on the bed",)


@pytest.fixture(scope="module")
def own_room() -> Any:
    return WEAVER.sample_room()


def test_the_page_has_sixty_sentences_and_measures_that_exist():
    assert len(CHECKS) == 60
    assert all(hasattr(promises.joint_measures, check[0]) for checks in CHECKS.values() for check in checks)


@pytest.mark.parametrize("text", KEPT)
def test_joints_keep_the_promise_and_the_record_says_so(text: str, own_room: Any):
    found = promises.outcome(text, CHECKS[text], own_room, WEAVER, seed=1)
    assert found["outcome"] == "kept", found
    assert found["done"], found["records"]


@pytest.mark.parametrize("text", NOT_THERE)
def test_what_is_not_kept_is_reported(text: str, own_room: Any):
    assert promises.outcome(text, CHECKS[text], own_room, WEAVER, seed=1)["outcome"] == "reported"
