"""The recipe from end to end with tiny numbers: train, write, load, score, draw."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("transformers")

from mmweaver.motion.motiongpt.motiongpt import MotionGPT, small_file
from mmweaver.motion.motiongpt.tokenizer import TokenizerConfig
from studies.manifest import StudyRun
from studies.motion import motiongpt_scores
from studies.motion.motion_language import LanguageRecipe
from studies.motion.motion_tokenizer import TokenizerRecipe
from studies.motion.motiongpt_data import ACTIVITIES, library_examples
from studies.motion.motiongpt_training import MotiongptRecipe, statistics, train
from studies.motion.motiongpt_weights import save_weights

TINY = MotiongptRecipe(
    tokenizer=TokenizerRecipe(steps=3, batch=4, frames=32), language=LanguageRecipe(steps=3, batch=4), seeds=range(2),
    shape=TokenizerConfig(codes=16, code_width=8, width=16),
)  # fmt: skip


@pytest.mark.slow  # a whole study; its parts: test_motion_tokenizer.py, _language.py and _classifier.py
def test_the_recipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    made = train(tmp_path / "no data", tmp_path / "work", TINY)
    assert made["examples"] == {"library": 24, "cmu": 0}
    file = tmp_path / "tiny.safetensors"
    save_weights(
        file, tokenizer=made["tokenizer"], language=made["language"], mean=made["mean"], std=made["std"],
        vocabulary=made["vocabulary"],
    )  # fmt: skip
    monkeypatch.setattr(motiongpt_scores, "TEST_SEEDS", range(2))
    monkeypatch.setattr(motiongpt_scores, "CLASSIFIER_SEEDS", range(2, 6))
    result = json.loads(
        motiongpt_scores.score(
            file, tmp_path / "no data", StudyRun("motiongpt_scores", tmp_path / "results")
        ).read_text()
    )
    rows = {row["dataset"]["name"]: row["metrics"]["r_precision_1"] for row in result["rows"]}
    assert len(rows) == 5
    assert rows["library, unseen seeds (oracle)"]["value"] > 0.8
    for metric in rows.values():
        low, high = metric["interval_95"]
        assert low <= metric["value"] <= high
    clip = MotionGPT.load(file).generate("a person walks", seconds=2.0)
    assert clip.joints_m.shape == (40, 22, 3)


def test_the_root_counts_more():
    examples = list(library_examples(range(2)))
    mean, std = statistics(examples)
    every = np.concatenate([example.features for example in examples])
    np.testing.assert_allclose(mean, every.mean(axis=0))
    assert std[0] == pytest.approx(every[:, 0].std() / 5)
    assert std[10] == pytest.approx(every[:, 4:67].std(axis=0).mean())
    assert replace(TINY, seeds=range(1)).seeds == range(1)


@pytest.mark.parametrize("activity", ["walking", "waving", "turning"])
def test_the_model_that_comes_along_does_what_it_is_told(activity: str):
    """Walks go somewhere on their feet, waves have a hand up, turns turn."""
    model = MotionGPT.load("small")
    assert small_file().stat().st_size < 15e6
    good = 0
    for seed in range(40, 48):
        sentence = motiongpt_scores.sentence_of(activity, seed, held_out=False)
        joints = model.generate(sentence, seconds=4.0, seed=seed).joints_m
        gone = np.linalg.norm(joints[-1, 0, :2] - joints[0, 0, :2])
        across = joints[:, 1, :2] - joints[:, 2, :2]
        turned = abs(np.ptp(np.unwrap(np.arctan2(across[:, 1], across[:, 0]))))
        raised = joints[:, [20, 21], 2].max() > joints[:, 12, 2].mean()
        good += {"walking": gone > 1.2, "waving": raised and gone < 0.5, "turning": turned > 0.8 and gone < 0.8}[
            activity
        ]
    assert good >= 7
    assert activity in ACTIVITIES
