"""Model cards."""

import hashlib
from pathlib import Path
from typing import Any

from huggingface_hub import ModelCard

from mmweaver.models.weights import WeightsCard
from mmweaver.training.model_card import model_card

CARD = WeightsCard(
    recipe="weaver", licence="MIT", dataset_sha256="d" * 64, radar="awr1843", steps=1500, seed=3, validation_loss=2.5,
    mmweaver_version="0.1", settings={"learning_rate": 1e-3},
)  # fmt: skip


def test_a_model_card_is_complete(tmp_path: Path):
    file = tmp_path / "weights.safetensors"
    file.write_bytes(b"weights")
    figures = {"this network": {"range_doppler": 5.25, "range_azimuth": 6.0}, "empty maps": {"range_doppler": 20.0,
               "range_azimuth": 21.0}}  # fmt: skip
    page = model_card(CARD, file, data="Made up.", evaluated_on="Other rooms.", figures=figures)
    assert page.startswith("---\nlicense: mit\nlibrary_name: mmweaver\n")
    for text in (
        "Made up.", "Other rooms.", "| this network | 5.25 | 6.00 |", "| empty maps | 20.00 | 21.00 |", "d" * 64,
        "| steps | 1,500, seed 3 |",
        "| learning_rate | 0.001 |", "uncalibrated",
    ):  # fmt: skip
        assert text in page
    assert hashlib.sha256(b"weights").hexdigest() in page
    data: Any = ModelCard(page).data
    assert data.pipeline_tag
    scores = {result.metric_type: result.metric_value for result in data.eval_results}
    assert scores == {"range_doppler": 5.25, "range_azimuth": 6.0}
