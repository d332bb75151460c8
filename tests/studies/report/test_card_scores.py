"""The front matter of model cards: the Hub can read it, and its scores are those of the results."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from huggingface_hub import ModelCard

from mmweaver.core.errors import InputError
from studies.report.card_scores import MODELS, with_scores
from studies.report.pages import filled_page

ROOT = Path(__file__).resolve().parents[3]
CARDS = [ROOT / "src" / "mmweaver" / "weights" / "README.md", *sorted((ROOT / "model_cards").glob("*.md"))]
OF_THE_HUB = {"other", "image-segmentation", "keypoint-detection", "tabular-classification"}  # tasks that it knows


def _front(card: Path) -> dict[str, Any]:
    found = re.match(r"---\n(.*?)\n---\n", card.read_text(encoding="utf-8"), re.DOTALL)
    assert found, card.name
    return yaml.safe_load(found[1])


def _row(record: Any, name: str) -> dict[str, Any]:
    """The numbers that a card's `row` names, read without the code that fills the card."""
    if "rows" in record:
        rows = [row for row in record["rows"] if name in (row.get("method"), row["dataset"]["name"])]
        assert len(rows) == 1
        return {key: metric["value"] for key, metric in rows[0]["metrics"].items()}
    for key in name.split("."):
        record = record[key]
    return record


@pytest.mark.parametrize("card", CARDS, ids=lambda card: card.stem)
def test_the_hub_can_read_a_card(card: Path):
    data: Any = ModelCard.load(card).data
    assert data.library_name == "mmweaver"
    assert data.license == "mit"
    assert data.pipeline_tag in OF_THE_HUB
    assert data.tags
    assert data.eval_results


@pytest.mark.parametrize("card", CARDS, ids=lambda card: card.stem)
def test_scores_of_a_card_are_those_of_the_results(card: Path):
    (index,) = _front(card)["model-index"]
    for result in index["results"]:
        source = result["source"]["name"]
        assert result["source"]["url"].endswith(f"/{source}")
        record = json.loads((ROOT / source).read_text(encoding="utf-8"))
        for score in result["metrics"]:
            assert score["value"] == pytest.approx(_row(record, score["args"]["row"])[score["type"]], abs=5.1e-5)


def test_every_weight_file_has_a_card():
    cards = "\n".join(card.read_text(encoding="utf-8") for card in CARDS)
    weights = [
        *(ROOT / "weights").glob("*.safetensors"),
        *(ROOT / "src" / "mmweaver" / "weights").glob("*.safetensors"),
    ]
    weights += [folder for folder in (ROOT / "weights").iterdir() if folder.is_dir()]
    for path in weights:
        assert path.name in cards, path
    assert {ROOT / name for name in MODELS} == set(CARDS)


def test_a_score_that_moved_makes_a_card_stale(tmp_path: Path):
    card = ROOT / "model_cards" / "pose_mars.md"
    shutil.copytree(ROOT / "results" / "shipped_models", tmp_path / "shipped_models")
    assert filled_page(card, tmp_path) == card.read_text(encoding="utf-8")
    file = tmp_path / "shipped_models" / "pose_mars.json"
    record = json.loads(file.read_text())
    record["rows"][0]["metrics"]["centroid_all"]["value"] = 1.23456
    file.write_text(json.dumps(record))
    assert "value: 1.2346" in filled_page(card, tmp_path)
    del record["rows"][0]["metrics"]["centroid_all"]
    file.write_text(json.dumps(record))
    with pytest.raises(InputError, match="centroid_all"):
        with_scores(card.read_text(encoding="utf-8"), MODELS["model_cards/pose_mars.md"], tmp_path)
