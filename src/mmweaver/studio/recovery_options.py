"""What the page offers as buttons where a request cannot be met as it is."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.studio.asked import Asked
from mmweaver.studio.rooms import DEMO


class NoWayError(InputError):
    """A request that cannot be met; `recovery_options` are buttons of the page: a label, and what they change."""

    def __init__(self, message: str, recovery_options: list[dict[str, Any]]):
        super().__init__(message)
        self.recovery_options = recovery_options


@contextmanager
def offer_recovery_options(asked: Asked) -> Iterator[None]:
    """Turns what would help a motion that finds no room, or does not fit its path, into what the page can change."""
    try:
        yield
    except NoRoomError as error:
        ways = [
            {"label": f"with {radar}", "change": {"radar": radar}} for radar in error.recovery_options.get("radars", ())
        ]
        if asked.room != DEMO:
            ways.append({"label": "in the bundled room", "change": {"room": DEMO}})
        raise NoWayError(str(error), ways) from None
    except InputError as error:
        if asked.path is None:
            raise
        raise NoWayError(str(error), [{"label": "without the path", "change": {"path": None}}]) from None
