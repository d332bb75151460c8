"""A tiny MotionGPT of random weights, and its checkpoint in the published format."""

from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.motion.motiongpt.language_model import add_motion_tokens, build_t5
from mmweaver.motion.motiongpt.tokenizer import MotionTokenizer, TokenizerConfig
from tests.motion.motiongpt_weights import plain_words, state_of, train_words

TINY = TokenizerConfig(codes=32, code_width=16, width=16)
TINY_T5: dict[str, Any] = {
    "d_model": 16, "d_kv": 8, "d_ff": 24, "num_layers": 2, "num_decoder_layers": 2, "num_heads": 2,
    "feed_forward_proj": "gated-gelu", "tie_word_embeddings": False,
}  # fmt: skip
SENTENCES = ["a person walks", "someone waves", "the man jumps"]


def tiny() -> tuple[MotionTokenizer, Any, str, np.ndarray, np.ndarray]:
    """Tokenizer, language model, words as JSON, mean and std with roots that stand at a metre."""
    torch.manual_seed(0)
    tokenizer = MotionTokenizer(TINY).eval()
    tokenizer.quantizer.codebook.normal_()
    words = train_words(SENTENCES)
    plain = plain_words(words)
    add_motion_tokens(words, TINY.codes)
    language = build_t5({**TINY_T5, "vocab_size": len(words)}).eval()
    rng = np.random.default_rng(0)
    mean, std = rng.normal(0, 0.3, 263), rng.uniform(0.01, 0.1, 263)
    mean[0], mean[3] = 0.0, 1.0
    return tokenizer, language, plain, mean.astype(np.float32), std.astype(np.float32)


def published(folder: Path, state: dict[str, torch.Tensor] | None = None, name: str = "motiongpt_s3_h3d.tar") -> Path:
    """A folder as a person would have it: checkpoint, mean.npy, std.npy and the words' tokenizer.json."""
    tokenizer, language, plain, mean, std = tiny()
    folder.mkdir(parents=True, exist_ok=True)
    np.save(folder / "mean.npy", mean)
    np.save(folder / "std.npy", std)
    (folder / "tokenizer.json").write_text(plain)
    (folder / "tokenizer_config.json").write_text(
        '{"tokenizer_class": "PreTrainedTokenizerFast", "pad_token": "<pad>", "eos_token": "</s>",'
        ' "unk_token": "<unk>"}'
    )
    everything = state if state is not None else state_of(tokenizer, language) | {
        "metrics.TM2TMetrics.count": torch.zeros(1), "_losses.losses_total": torch.zeros(1)
    }  # fmt: skip
    torch.save({"epoch": 3, "state_dict": everything, "global_step": 1}, folder / name)
    return folder / name
