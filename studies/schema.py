"""The schema of results/<experiment>/<method>.json, enforced on every record, row and metric.

A record says where its figures come from, each row what was measured and on which data, each metric what its number
means and what it is compared with:

    {"schema_version": 2, "origin": "measured", "study", "experiment", "method", "config",
     "provenance": {...}, "hardware": {...}, "manifest": {...},
     "rows": [{"dataset": {"name", "sha256", ...}, "n", "seeds": [...], "seconds": {stage: s},
               "metrics": {name: {"value", "unit", "definition", "version", "baseline": {name: value},
                                  "oracle": {name: value}, "interval_95": [low, high], ...}},
               "unknown": {field: reason}, ...}]}

A required field that is not known is null, and `unknown` of the record or row names it and says why. The name may have
"*" for any metric: {"metrics.*.baseline": "costs are not compared with a baseline"}.
"""

import fnmatch
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError

SCHEMA_VERSION = 2
RECORD_FIELDS = (
    "schema_version", "origin", "study", "experiment", "method", "config", "provenance", "hardware", "manifest", "rows",
)  # fmt: skip
ROW_FIELDS = ("dataset.name", "dataset.sha256", "n", "seeds", "seconds")
METRIC_FIELDS = ("value", "unit", "definition", "version", "baseline")
MANIFEST_FIELDS = ("inputs", "outputs", "wall_s", "cpu_s")
RENAMED = ("floor", "ceiling", "twin", "low", "high", "interval", "beside")  # names of schema 1, not allowed in 2


def metric(
    value: float | None,
    unit: str,
    definition: str,
    *,
    version: int = 1,
    baseline: Mapping[str, float | None] | None = None,
    oracle: Mapping[str, float | None] | None = None,
    interval_95: tuple[float, float] | None = None,
    **more: Any,
) -> dict[str, Any]:
    """A metric of a row. `baseline`, `oracle`: scores of others on the same data, by name."""
    record: dict[str, Any] = {"value": value, "unit": unit, "definition": definition, "version": version}
    record["baseline"] = None if baseline is None else dict(baseline)
    if oracle is not None:
        record["oracle"] = dict(oracle)
    if interval_95 is not None:
        record["interval_95"] = [float(edge) for edge in interval_95]
    return {**record, **more}


def violations(record: Mapping[str, Any]) -> list[str]:
    """What is wrong with a record, one line each; nothing for a valid one."""
    found = [f"{name} is missing" for name in RECORD_FIELDS if name not in record]
    if found:
        return found
    if record["schema_version"] != SCHEMA_VERSION:
        found.append(f"schema_version is {record['schema_version']}, not {SCHEMA_VERSION}")
    if record["origin"] not in ("measured", "paper"):
        found.append(f"origin is {record['origin']!r}, neither 'measured' nor 'paper'")
    found += _missing(record["manifest"], MANIFEST_FIELDS, record.get("unknown", {}), "manifest.")
    found += _missing(record["provenance"], ("mmweaver_version", "commit", "dirty"), _commit_reasons(record))
    for index, row in enumerate(record["rows"]):
        found += [f"rows[{index}]: {line}" for line in _row_violations(row)]
    return found


def _commit_reasons(record: Mapping[str, Any]) -> dict[str, str]:
    reason = record["provenance"].get("commit_unknown")
    return {**record.get("unknown", {}), **({} if reason is None else {"commit": reason, "dirty": reason})}


def _row_violations(row: Mapping[str, Any]) -> list[str]:
    unknown = row.get("unknown", {})
    found = _missing(row, ROW_FIELDS, unknown)
    if not isinstance(row.get("seconds"), (dict, type(None))):
        found.append("seconds must be {stage: seconds}")
    metrics = row.get("metrics")
    if not metrics:
        return [*found, "metrics are missing"]
    for name, one in metrics.items():
        found += _missing(one, METRIC_FIELDS, unknown, f"metrics.{name}.")
        found += [f"metrics.{name}.{old} is a name of schema 1" for old in RENAMED if old in one]
        if "interval_95" in one and len(one["interval_95"]) != 2:
            found.append(f"metrics.{name}.interval_95 must be [low, high]")
    return found


def _missing(
    record: Mapping[str, Any], fields: tuple[str, ...], unknown: Mapping[str, str], prefix: str = ""
) -> list[str]:
    """Fields that are absent, or null without a reason."""
    found = []
    for field in fields:
        value: Any = record
        for part in field.split("."):
            value = value.get(part, ...) if isinstance(value, Mapping) else ...
        if value is ...:
            found.append(f"{prefix}{field} is missing")
        elif value is None and not any(fnmatch.fnmatchcase(prefix + field, pattern) for pattern in unknown):
            found.append(f"{prefix}{field} is null, and `unknown` gives no reason")
    return found


def check_record(record: Mapping[str, Any], name: str) -> None:
    """Raises InputError with the first violations of a record."""
    found = violations(record)
    if found:
        more = f" (and {len(found) - 3} more)" if len(found) > 3 else ""
        raise InputError(f"{name} does not follow the schema of results: {'; '.join(found[:3])}{more}")


def read_record(path: Path) -> dict[str, Any]:
    """A result file. Raises InputError where it is missing or no result."""
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{path} is missing; run the study first: python -m studies list") from None
    except ValueError:
        raise InputError(f"{path} is not JSON; restore it or run its study again") from None
    if not isinstance(record, dict) or "rows" not in record:
        raise InputError(f"{path} is no result: it has no rows")
    return record
