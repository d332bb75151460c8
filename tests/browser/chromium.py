"""A real browser and a running studio for tests; they are skipped where either is missing."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
]


READY, IDLE = "main[data-state=ready]", "main[data-busy=false]"  # of the page


class Running(str):
    """The address of a studio in a process of its own."""

    pid = 0

    @property
    def memory_mb(self) -> float:
        """Resident memory of its process."""
        said = Path(f"/proc/{self.pid}/status").read_text()
        return int(re.findall(r"VmRSS:\s+(\d+)", said)[0]) / 1024


@contextmanager
def running_studio(*options: str, log: Path) -> Iterator[Running]:
    """A studio, until the block ends."""
    command = [sys.executable, "-m", "mmweaver", "studio", "--no-browser", "--port", "0", *options]
    with log.open("w") as out:
        process = subprocess.Popen(
            command, stdout=out, stderr=subprocess.STDOUT, env={**os.environ, "PYTHONUNBUFFERED": "1"}
        )
    try:
        while True:
            said = log.read_text()
            found = re.search(r"is ready: (\S+)", said)
            if found:
                address = Running(found[1])
                address.pid = process.pid
                yield address
                return
            if process.poll() is not None:
                pytest.fail(f"the studio ended: {said}")
            try:
                process.wait(0.1)
            except subprocess.TimeoutExpired:
                continue
    finally:
        process.terminate()
        process.wait(20)


def needs_browser() -> str:
    """The path of Chromium, or the test is skipped."""
    pytest.importorskip("playwright", reason="playwright is not installed")
    pytest.importorskip("starlette", reason="the studio's extra is not installed")
    if CHROMIUM is None:
        pytest.skip("no Chromium here; Debian: apt-get install chromium")
    return CHROMIUM
