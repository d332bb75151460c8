"""Names and durations of the stages of a long job."""

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from time import perf_counter
from typing import Any

_LOG = logging.getLogger(__name__)


@lru_cache(maxsize=1)
def _thread_pools(modules: int) -> Any:
    """Thread pools of the loaded libraries, cached per number of modules: the search takes 4 ms."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


class Stages:
    """Times the named stages of a long job and notifies a listener at the start of each.

    A stage runs on one BLAS thread: the matrices are small, and several threads took 4 to 15 times the CPU time.

    >>> heard = []
    >>> stages = Stages(heard.append)
    >>> with stages("read the room"):
    ...     pass
    >>> heard, list(stages.seconds)
    (['read the room'], ['read the room'])
    """

    def __init__(self, listener: Callable[[str], object] | None = None):
        """Creates a timer.

        Args:
            listener: Called with the name of each stage as it begins. Default: none.
        """
        self.seconds: dict[str, float] = {}
        self._listener = listener

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        """Context that times one stage; times of repeated stages accumulate in `seconds`.

        Args:
            name: Name of the stage.
        """
        if self._listener is not None:
            self._listener(name)
        start = perf_counter()
        try:
            with _thread_pools(len(sys.modules)).limit(limits=1, user_api="blas"):
                yield
        finally:
            seconds = perf_counter() - start
            self.seconds[name] = self.seconds.get(name, 0.0) + seconds
            _LOG.info("%s: %.3f s", name, seconds)
