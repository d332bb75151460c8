"""What a run of the tests cost: CPU seconds in all, and the ten tests and files that took most.

CPU seconds, of child processes too, do not depend on what else the machine does; no test compares them with anything.
"""

import os
from collections import Counter
from collections.abc import Generator
from typing import Any

import pytest

MOST = 10  # lines of tests, and of files
_PROPERTY = "cpu_s"


def cpu_s() -> float:
    """Of this process and of its children that have ended (on Windows: of this process alone)."""
    return sum(os.times()[:4])


class CpuSummary:
    """A plug-in of pytest, for one process or for the workers of pytest-xdist and their controller."""

    def __init__(self) -> None:
        self.tests: Counter[str] = Counter()
        self.workers_s = 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        if call.when == "teardown":  # its report is the last: it carries what setup, call and fixtures took
            report.user_properties.append((_PROPERTY, cpu_s() - item.stash[_BEGAN]))
        return report

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        item.stash[_BEGAN] = cpu_s()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        properties: dict[str, Any] = dict(report.user_properties)
        self.tests[report.nodeid] += properties.get(_PROPERTY, 0.0)

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if hasattr(session.config, "workeroutput"):
            session.config.workeroutput[_PROPERTY] = cpu_s()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        self.workers_s += getattr(node, "workeroutput", {}).get(_PROPERTY, 0.0)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        files: Counter[str] = Counter()
        for name, spent in self.tests.items():
            files[name.partition("::")[0]] += spent
        # workers are children of the controller, but those that have not ended yet are not in its times
        own_s = sum(os.times()[:2]) if self.workers_s else cpu_s()
        in_all = own_s + self.workers_s
        elsewhere = in_all - self.tests.total()
        terminalreporter.section(f"{in_all:.0f} CPU seconds, {elsewhere:.0f} of them for imports and collection")
        most = int(os.environ.get("CPU_LINES", MOST))
        for counted in (files, self.tests):
            for name, spent in counted.most_common(most):
                if spent >= 0.1:
                    terminalreporter.line(f"{spent:7.1f} s  {name}")
            terminalreporter.line("")


_BEGAN = pytest.StashKey[float]()
