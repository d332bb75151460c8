"""Commands of the command line in forked children: how each ended, what it printed, and whether it took too long."""

import contextlib
import io
import json
import os
import select
import signal
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

LATE_S = 60.0


@dataclass(frozen=True, kw_only=True)
class Ended:
    """How a command ended: its exit status, or the exception that it should have caught, or "late"."""

    status: int | str
    stderr: str

    @property
    def is_sound(self) -> bool:
        """Done, or refused in one line."""
        lines = self.stderr.strip().splitlines()
        is_refused = self.status == 2 and len(lines) == 1 and lines[0].startswith("mmweaver: error: ")
        return is_refused or (self.status == 0 and not lines)


def run_at_once(actions: list[Callable[[], int]]) -> list[Ended]:
    """Runs functions of the command line at the same time, each in a forked child that begins when all are there."""
    started, start = os.pipe()
    children = []
    for action in actions:
        receiver, sender = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(start)
            os.read(started, 1)  # until all others are there, too
            with os.fdopen(sender, "w") as pipe:
                json.dump(_run(action), pipe)
            os._exit(0)
        os.close(sender)
        children.append((child, receiver))
    os.close(start)
    os.close(started)
    return [_ended(child, receiver) for child, receiver in children]


def _run(action: Callable[[], int]) -> tuple[Any, str]:
    error = io.StringIO()
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(error):
            return action(), error.getvalue()[-3000:]
    except BaseException:
        return traceback.format_exc()[-1500:], error.getvalue()[-3000:]


def _ended(child: int, receiver: int) -> Ended:
    is_there, _, _ = select.select([receiver], [], [], LATE_S)
    if not is_there:
        os.kill(child, signal.SIGKILL)
    with os.fdopen(receiver) as pipe:
        text = pipe.read()
    os.waitpid(child, 0)
    status, stderr = json.loads(text) if text else ("late", "")
    return Ended(status=status, stderr=stderr)
