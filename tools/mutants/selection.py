"""A plug-in of pytest: runs the tests named in a file, in its order, and writes down which failed."""

import json
import os
from pathlib import Path

import pytest

SELECTED, FAILED = "MUTANTS_SELECTED", "MUTANTS_FAILED"


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    wanted = {name: place for place, name in enumerate(json.loads(Path(os.environ[SELECTED]).read_text()))}
    selected = [item for item in items if item.nodeid in wanted]
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid not in wanted])
    items[:] = sorted(selected, key=lambda item: wanted[item.nodeid])


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    if report.failed:
        _note(report.nodeid)


def pytest_collectreport(report: pytest.CollectReport) -> None:
    if report.failed:
        _note(report.nodeid)


def _note(name: str) -> None:
    with Path(os.environ[FAILED]).open("a", encoding="utf-8") as file:
        file.write(name + "\n")
