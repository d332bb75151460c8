"""The log on stderr."""

import logging

import pytest

from mmweaver.cli.log import set_up_log
from mmweaver.core.stages import Stages


def run_a_stage() -> None:
    with Stages()("read the room"):
        logging.getLogger("mmweaver.test").warning("careful")


@pytest.mark.parametrize(
    ("level", "verbose", "shown"), [(None, False, 1), (None, True, 2), ("error", True, 0), ("debug", False, 2)]
)
def test_levels(level: str | None, verbose: bool, shown: int, capsys: pytest.CaptureFixture[str]):
    set_up_log(level, verbose=verbose)
    set_up_log(level, verbose=verbose)  # as often as wanted: each line once
    run_a_stage()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == shown
    assert ("read the room" in "".join(lines)) == (shown == 2)
    set_up_log(None, verbose=False)
