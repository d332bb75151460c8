"""Checks of shapes and types that cost little: the first calls of every function in every file of tests.

The import hook of jaxtyping wraps every function of the package. One check costs some 50 microseconds, and functions of
inner loops are called a million times: with all calls checked, tests of motion took three times as long.
"""

import functools
import sys
from collections.abc import Callable
from types import CodeType, FunctionType
from typing import Any, ClassVar

import jaxtyping

FIRST_CALLS = 30  # of each function in each file of tests


class _Current:
    file = 0  # number of the running file of tests: a new one checks anew
    most_calls = FIRST_CALLS


class _Calls:
    """Of one function of the source; one that is defined anew in each call of another is still the same."""

    of: ClassVar[dict[CodeType, "_Calls"]] = {}

    def __init__(self) -> None:
        self.file, self.left = -1, 0

    def is_checked(self) -> bool:
        if self.file != _Current.file:
            self.file, self.left = _Current.file, _Current.most_calls
        self.left -= 1
        return self.left >= 0


def next_file() -> None:
    """From here on the first calls of every function are checked again."""
    _Current.file += 1


def check_every_call() -> None:
    """As the hook does by itself; the nightly run asks for it."""
    _Current.most_calls = sys.maxsize


def check_first_calls() -> None:
    """Makes the hook check only the first calls of what is imported from now on."""
    every_call = jaxtyping.jaxtyped

    def jaxtyped(decorated: Any = None, *, typechecker: Any) -> Any:
        if decorated is None:
            return functools.partial(jaxtyped, typechecker=typechecker)
        if not isinstance(decorated, type):
            return _first_calls(decorated, lambda: every_call(decorated, typechecker=typechecker))
        plain = decorated.__init__
        checked = every_call(decorated, typechecker=typechecker)
        if checked.__init__ is not plain:  # a dataclass
            with_checks = checked.__init__
            checked.__init__ = _first_calls(plain, lambda: with_checks)
        return checked

    jaxtyping.jaxtyped = jaxtyped  # the name that the hook writes before each function


def _first_calls(plain: FunctionType, make_checked: Callable[[], Callable[..., Any]]) -> Callable[..., Any]:
    """Checks are compiled by the first call that needs them: 2 milliseconds, and most functions are never called."""
    calls = _Calls.of.setdefault(plain.__code__, _Calls())
    checked: Callable[..., Any] | None = None

    @functools.wraps(plain)
    def function(*args: Any, **kwargs: Any) -> Any:
        __tracebackhide__ = True
        nonlocal checked
        if not calls.is_checked():
            return plain(*args, **kwargs)
        if checked is None:
            checked = make_checked()
        return checked(*args, **kwargs)

    return function
