"""Scores in the front matter of model cards, as the Hub shows them (`model-index`), filled from results.

`python -m studies tables` fills them with the tables. All else in the front matter is written by hand.
"""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
DIGITS = 4


@dataclass(frozen=True, kw_only=True)
class CardScores:
    """Which scores a card shows: `metrics` of a row of `source`, named by its method, data set, or keys with dots."""

    name: str  # of the model
    source: str  # from the root of the repository
    row: str
    metrics: Mapping[str, str]  # {key in the row: what it is called}
    dataset: str  # slug
    dataset_name: str


ROOMS = {"dataset": "mmweaver-rooms", "dataset_name": "Generated rooms of kinds not trained on"}
SSIM = {"ra_ssim": "SSIM of range-azimuth maps", "rd_ssim": "SSIM of range-Doppler maps"}
MODELS = {
    "src/mmweaver/weights/README.md": CardScores(
        name="weaver", source="results/learned_scores/test_room.json", row="weaver", metrics=SSIM, **ROOMS
    ),
    "model_cards/paper_power.md": CardScores(
        name="paper_power", source="results/learned_scores/paper_power.json", row="paper_power", metrics=SSIM, **ROOMS
    ),
    "model_cards/segmenter.md": CardScores(
        name="segmenter", source="model_cards/segmenter.json", row="unseen_kinds.network", **ROOMS,
        metrics={"miou": "Mean intersection over union", "right": "Cells right"},
    ),
    "model_cards/pose_mars.md": CardScores(
        name="pose_mars", source="results/shipped_models/pose_mars.json", row="pose_mars",
        dataset="mars", dataset_name="MARS, subject 1",
        metrics={"centroid_all": "Mean distance of joints, cm", "centroid_arms": "Of the arms, cm",
                 "centroid_legs": "Of the legs, cm"},
    ),
    "model_cards/recogniser_radhar.md": CardScores(
        name="recogniser_radhar", source="results/shipped_models/recogniser_radhar.json", row="recogniser_radhar",
        dataset="radhar", dataset_name="RadHAR, 131 recordings",
        metrics={"window": "Balanced accuracy of windows of 2 s", "recording": "Balanced accuracy of recordings"},
    ),
    "model_cards/motiongpt_small.md": CardScores(
        name="motiongpt_small", source="model_cards/motiongpt_small.json", row="words_never_trained",
        dataset="mmweaver-activities", dataset_name="Twelve activities in words never trained",
        metrics={"r_precision_1": "R-precision, first of twelve", "r_precision_3": "R-precision, first three"},
    ),
}  # fmt: skip


def with_scores(text: str, scores: CardScores, results: Path) -> str:
    """The text of a card with the `model-index` of its front matter filled from this folder of results.

    Raises InputError for a score that the results do not have.
    """
    from huggingface_hub import EvalResult, ModelCard

    card = ModelCard(text, ignore_metadata_errors=True)
    data: Any = card.data
    inside = scores.source.removeprefix("results/")
    file = ROOT / scores.source if inside == scores.source else results / inside
    found = values_of(json.loads(file.read_text(encoding="utf-8")), scores.row)
    missing = [key for key in scores.metrics if key not in found]
    if missing:
        raise InputError(f"{scores.source} has no {missing[0]} of {scores.row!r}; run its study")
    data.model_name = scores.name
    data.eval_results = [
        EvalResult(
            task_type=data.pipeline_tag, dataset_type=scores.dataset, dataset_name=scores.dataset_name,
            metric_type=key, metric_name=name, metric_value=round(found[key], DIGITS), metric_args={"row": scores.row},
            source_name=scores.source, source_url=f"{PROJECT['urls']['Source']}/blob/main/{scores.source}",
        )
        for key, name in scores.metrics.items()
    ]  # fmt: skip
    return str(card)


def values_of(record: Any, row: str) -> dict[str, float]:
    """The numbers of one row of a result, or of a place in other JSON."""
    if "rows" not in record:
        for key in row.split("."):
            record = record[key]
        return {name: value for name, value in record.items() if isinstance(value, int | float)}
    (found,) = [one for one in record["rows"] if row in (one.get("method"), one["dataset"]["name"])]
    return {name: metric["value"] for name, metric in found["metrics"].items()}
