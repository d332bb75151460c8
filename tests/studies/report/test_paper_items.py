"""The paper's items: each has a number from results or a reason, and its study exists."""

import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from studies.report.paper_items import PaperItem, paper_items, paper_table
from studies.study import study_files

RESULTS = Path(__file__).resolve().parents[3] / "results"
ITEMS = paper_items()


def test_every_item_has_a_number_or_a_reason():
    assert len({item.name for item in ITEMS}) == len(ITEMS) > 20
    for item in ITEMS:
        assert bool(item.source) != bool(item.missing), item.name
        assert item.missing or (item.ours and item.reading), item.name


@pytest.mark.parametrize("item", [item for item in ITEMS if item.study], ids=lambda item: item.name)
def test_the_study_of_an_item_exists(item: PaperItem):
    assert shlex.split(item.study)[0] in study_files()


def test_numbers_come_from_the_results():
    lines = paper_table(RESULTS).splitlines()
    assert any("91.7 % (86.1 to 97.2)" in line and "87.5 %" in line and "83.7 % -> 90.4 %" in line for line in lines)
    assert any("zeros: **0.957**" in line and "| 0.88 |" in line for line in lines)


def test_a_field_that_is_gone_is_an_error():
    item = next(item for item in ITEMS if item.name == "signal")
    with pytest.raises(InputError, match="'signal'"):
        replace(item, ours="{metrics.nope}").cells(RESULTS)
    with pytest.raises(InputError, match="nope"):
        replace(item, where={"method": "nope"}).cells(RESULTS)
