"""Completes the rows of a result: what is common to all of them, and what each is compared with."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from studies.scores.scorecard import METRICS

COST = "a cost, not a score: it is compared with nothing"
NONE_MEASURED = "no baseline was measured for it"

# {name: (unit, definition)} of metrics that the scorecard does not have
DEFINITIONS = {
    "magnitude_nmse_db": ("dB", "squared error of the magnitudes over the energy of the ground truth"),
    "energy_db": ("dB", "energy of the cube over that of the ground truth"),
    "cpu_s": ("s", "CPU seconds from photo and joints to the cube"),
    "mean_ra_db": ("dB", "absolute difference of expected range-azimuth maps above the noise"),
    "mean_rd_db": ("dB", "absolute difference of expected range-Doppler maps above the noise"),
    "person_ra_db": ("dB", "absolute difference of expected range-azimuth maps of the person alone, above the noise"),
    "person_rd_db": ("dB", "absolute difference of expected range-Doppler maps of the person alone, above the noise"),
    "accuracy": ("1", "share of right answers"),
    "gain": ("1", "accuracy less that of training on other rooms alone"),
    "log_loss": ("nat", "cross-entropy of the answers"),
    "log_loss_gain": ("nat", "cross-entropy of training on other rooms alone less this one"),
}


def complete_rows(
    rows: Iterable[Mapping[str, Any]],
    *,
    dataset: Mapping[str, Any] | None = None,
    seeds: list[int] | None = None,
    seconds: Mapping[str, float] | None = None,
    baselines: Iterable[str] = (),
    oracles: Iterable[str] = (),
    unknown: Mapping[str, str] | None = None,
) -> list[dict[str, Any]]:
    """Rows that follow `studies.schema`.

    Args:
        rows: rows with at least metrics; those of several methods on the same data name their `method`.
        dataset, seeds, seconds: of rows that do not have their own.
        baselines, oracles: names of methods among the rows whose value of the same metric every row is compared with.
        unknown: reasons for fields that stay null.
    """
    given = [dict(row) for row in rows]
    by_method = {row["method"]: row["metrics"] for row in given if "method" in row}
    common = {"dataset": dataset, "seeds": seeds, "seconds": seconds}
    complete = []
    for row in given:
        split = {"split": row.pop("split")} if "split" in row else {}
        row = {**{name: value for name, value in common.items() if name not in row}, **row}
        row["dataset"] = {"sha256": None, **(row["dataset"] or {}), **split}
        row["metrics"] = {
            name: _complete_metric(name, metric, by_method, tuple(baselines), tuple(oracles))
            for name, metric in row["metrics"].items()
        }
        reasons = {**(unknown or {}), **_reasons(row), **row.pop("unknown", {})}
        complete.append({**row, **({"unknown": reasons} if reasons else {})})
    return complete


def _complete_metric(
    name: str,
    metric: Mapping[str, Any],
    by_method: Mapping[str, Mapping[str, Any]],
    baselines: tuple[str, ...],
    oracles: tuple[str, ...],
) -> dict[str, Any]:
    """A metric with unit, definition and version, and the scores of others on the same data."""
    known = METRICS.get(name)
    unit, definition = (known.unit, known.definition) if known else DEFINITIONS.get(name, (None, None))
    others = {
        kind: {other: by_method[other][name]["value"] for other in names if name in by_method.get(other, {})}
        for kind, names in (("baseline", baselines), ("oracle", oracles))
    }
    record = {"unit": unit, "definition": definition, "version": known.version if known else 1, **metric}
    for kind, values in others.items():
        if values or metric.get(kind):
            record[kind] = {**values, **(metric.get(kind) or {})}
    return {"value": record.pop("value"), "baseline": None, **record}


def _reasons(row: Mapping[str, Any]) -> dict[str, str]:
    """Reasons that follow from what a metric is."""
    is_cost = {name: metric["unit"] in ("s", "GB", "kB", "TB") for name, metric in row["metrics"].items()}
    reasons = {}
    for name, metric in row["metrics"].items():
        if metric["value"] is None:
            reasons[f"metrics.{name}.value"] = "it does not exist here, or is not a finite number"
        if metric["baseline"] is None:
            reasons[f"metrics.{name}.baseline"] = COST if is_cost[name] else NONE_MEASURED
    return reasons


def dataset_of(data: Path) -> dict[str, Any]:
    """Name and hash of a data set of `mmweaver dataset`: the hash of its plan, from which it is made bit for bit."""
    from mmweaver.datasets.dataset_store import plan_text

    return plan_dataset(json.loads(plan_text(data)))


def plan_dataset(plan: Mapping[str, Any]) -> dict[str, Any]:
    """The same of a plan that was read."""
    text = json.dumps(plan, sort_keys=True)
    return {"name": "data set of mmweaver dataset", "sha256": hashlib.sha256(text.encode()).hexdigest(),
            "hashed": "its plan, as JSON with sorted keys"}  # fmt: skip
