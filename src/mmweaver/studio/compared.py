"""Two results of a session compared: the numbers of `mmweaver compare`."""

from typing import Any

from mmweaver.comparison.compare_signals import FeatureComparison, compare_signals
from mmweaver.comparison.signal_evidence import ComparedSignal
from mmweaver.core.errors import InputError
from mmweaver.studio.sessions import Result


def compared(a: Result, b: Result) -> dict[str, Any]:
    """Text and values of the comparison, and a row of the page's table for each feature that both sides show.

    Raises InputError where one of them is a point cloud alone, or the two have no common ranges.
    """
    found = compare_signals([_signal(a, "A")], [_signal(b, "B")], names=(f"A: {a.title}", f"B: {b.title}"))
    return {"text": found.text(), "values": found.to_values(), "rows": [_row(one) for one in found.ranked]}


def _signal(result: Result, name: str) -> ComparedSignal:
    if result.cube is None:
        raise InputError(f"{name} is a point cloud alone; numbers need a signal on both sides")
    adc = None if result.generation is None else result.generation.adc
    return ComparedSignal(name=result.title, cube=result.cube, adc=adc, points=result.points, meta=result.meta)


def _row(one: FeatureComparison) -> dict[str, Any]:
    assert one.difference is not None
    unit = one.feature.unit
    return {
        "title": one.feature.title, "effect": one.difference.effect_size, "a": one.a.text(unit), "b": one.b.text(unit),
        "gives_away": one.gives_away,
    }  # fmt: skip
