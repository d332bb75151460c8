"""Silences logs while the Hub's client reports every retry; the user gets one error line instead."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def hub_log_off() -> Iterator[None]:
    """Suppresses all logs inside."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)
