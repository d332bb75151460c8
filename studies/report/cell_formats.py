"""Templates of table cells: str.format over a result row, with formats for metrics and their intervals.

    "{metrics.ra_ssim:interval.2}"  ->  "0.40 (0.38 to 0.41)"
    "{seconds.fit:.0f}"             ->  "12"

| format | of 0.4012 in 0.35 to 0.45 |
|---|---|
| `fixed.2`, `interval.2` | 0.40, 0.40 (0.35 to 0.45) |
| `number`, `number_interval` | three digits, two decimals at most: 0.40, 0.40 (0.35 to 0.45) |
| `percent.0`, `percent_interval.1` | 40 %, 40.1 % (35.0 to 45.0) |
| `signed_interval.3`, `points_interval.1` | +0.401 (+0.350 to +0.450), +40.1 (+35.0 to +45.0) |
| `share.1`, `share_interval.1` | 40.1 % of 200, 40.1 % of 200 (35.0 to 45.0) |

Any other format is Python's own, of the number or of the value of the metric.
"""

import string
from collections.abc import Callable, Mapping
from typing import Any


class MissingFieldError(KeyError):
    """A template names a field that the row does not have."""


def cell(template: str, context: Mapping[str, Any], missing: str = "-") -> str:
    """A filled template; `missing` where a field is absent."""
    try:
        return _FORMATTER.vformat(template, (), context)
    except MissingFieldError:
        return missing


def number(value: float | None) -> str:
    """A number in three digits, two decimals at most; never minus zero.

    >>> number(0.123), number(-12.34), number(-0.001), number(None)
    ('0.12', '-12.3', '0.00', '-')
    """
    if value is None:
        return "-"
    text = f"{value:.2f}" if abs(value) < 10 else f"{value:.1f}"
    return text.removeprefix("-") if float(text) == 0 else text


def line(*cells: str) -> str:
    """A line of a Markdown table."""
    return "| " + " | ".join(cells) + " |"


def markdown(heads: list[str], lines: list[list[str]]) -> str:
    """A Markdown table."""
    return "\n".join([line(*heads), line(*["---"] * len(heads)), *(line(*cells) for cells in lines)])


class _CellFormatter(string.Formatter):
    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        value: Any = kwargs
        for part in field_name.split("."):
            if not isinstance(value, Mapping) or part not in value:
                raise MissingFieldError(field_name)
            value = value[part]
        return value, field_name

    def format_field(self, value: Any, format_spec: str) -> str:
        metric = value if isinstance(value, Mapping) else {"value": value}
        name, _, digits = format_spec.partition(".")
        if name in _SPECIAL:
            return _SPECIAL[name](metric, digits)
        if metric["value"] is None:
            return "-"
        if name in _STYLES:
            return _styled(metric, name, digits)
        return format(metric["value"], format_spec)


_FORMATTER = _CellFormatter()
# {name: (factor, sign, what follows the number)}
_STYLES = {
    "fixed": (1, "", ""), "number": (1, "", ""), "percent": (100, "", " %"), "share": (100, "", " %"),
    "interval": (1, "", ""), "number_interval": (1, "", ""), "percent_interval": (100, "", " %"),
    "share_interval": (100, "", " %"), "signed_interval": (1, "+", ""), "points_interval": (100, "+", ""),
}  # fmt: skip


def _edges_percent(metric: Mapping[str, Any], digits: str) -> str:
    low, high = metric["interval_95"]
    return f"{100 * low:.{digits}f} to {100 * high:.{digits}f} %"


# {name: text of a metric}; for what no number says
_SPECIAL: dict[str, Callable[[Mapping[str, Any], str], str]] = {
    "edges_percent": _edges_percent,
    "split": lambda metric, digits: {"train": "what it trained on", "test_room": "unseen kinds"}[metric["value"]],
}


def _styled(metric: Mapping[str, Any], name: str, digits: str) -> str:
    factor, sign, ending = _STYLES[name]

    def text(value: float) -> str:
        return number(factor * value) if name.startswith("number") else f"{factor * value:{sign}.{digits}f}"

    of = f" of {metric['of']}" if name.startswith("share") and "of" in metric else ""
    edges = metric.get("interval_95") if name.endswith("interval") else None
    if sign and not any((metric["value"], *(edges or ()))):
        return ""  # the baseline itself
    interval = "" if edges is None else f" ({text(edges[0])} to {text(edges[1])})"
    return f"{text(metric['value'])}{ending}{of}{interval}"
