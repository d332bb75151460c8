"""Silences the log of the Hub's client, which reports every retry; the user gets one error line instead."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

_LOGGERS = ("huggingface_hub", "httpx", "urllib3")


@contextmanager
def hub_log_off() -> Iterator[None]:
    """Suppresses the log of the Hub's client and of its HTTP libraries."""
    loggers = [logging.getLogger(name) for name in _LOGGERS]
    before = [logger.level for logger in loggers]
    children = [one for one in map(logging.getLogger, list(logging.root.manager.loggerDict)) if _is_below(one.name)]
    disabled = [one.disabled for one in children]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    for child in children:
        child.disabled = True
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
        for child, was in zip(children, disabled, strict=True):
            child.disabled = was


def _is_below(name: str) -> bool:
    return name.startswith(tuple(f"{one}." for one in _LOGGERS))
