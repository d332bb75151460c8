"""A tiny T5 learns the codes of a sentence."""

from typing import Any

import pytest
import torch

pytest.importorskip("transformers")

from mmweaver.motion.motiongpt.language_model import sample_codes
from studies.motion.motion_language import LanguageRecipe, train_language

SIZES: dict[str, Any] = {
    "vocab_size": 6 + 11, "d_model": 32, "d_kv": 16, "d_ff": 64, "num_layers": 1, "num_decoder_layers": 1,
    "num_heads": 2,
    "dropout_rate": 0.0, "feed_forward_proj": "gated-gelu", "tie_word_embeddings": False,
}  # fmt: skip
PAIRS = [([3, 4, 1], [0, 1, 2, 3]), ([3, 5, 1], [7, 6, 5, 4])]


def test_each_sentence_gets_its_codes():
    model = train_language(PAIRS, SIZES, 6, 8, LanguageRecipe(steps=120, batch=8, learning_rate=5e-3, warm_up=5))
    for words, codes in PAIRS:
        for tokens in (4, None):
            said = sample_codes(
                model, torch.tensor([words]), first_motion_id=6, codes=8, tokens=tokens, most_tokens=8, seed=0,
                temperature=0.2,
            )  # fmt: skip
            assert said == codes
