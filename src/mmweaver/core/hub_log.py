"""Silences logging while the Hub client reports every retry; the user gets one error line instead."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def hub_log_off() -> Iterator[None]:
    """Context in which all logging is suppressed."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)
