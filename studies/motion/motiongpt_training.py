"""Trains a small MotionGPT from scratch on one CPU core: the same architecture with smaller sizes.

python -m studies run motiongpt_training --data shared/data --weights weights/motiongpt_small.safetensors

An interrupted training continues where it stopped. The study `motiongpt_scores` evaluates the result.
"""

import argparse
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Float

from mmweaver.motion.mocap.joint_arrays import CONTACTS, ROTATIONS, VELOCITIES
from mmweaver.motion.motiongpt.language_model import add_motion_tokens
from mmweaver.motion.motiongpt.tokenizer import MotionTokenizer, TokenizerConfig
from studies.manifest import StudyRun
from studies.motion.motion_language import LanguageRecipe, train_language
from studies.motion.motion_tokenizer import TokenizerRecipe, train_tokenizer
from studies.motion.motiongpt_data import SentenceExample, cmu_examples, library_examples
from studies.motion.motiongpt_weights import plain_words, save_weights, train_words
from studies.study import Reads

Array = np.ndarray
TRAIN_SEEDS = range(1000, 1080)
CMU_COPIES = 3  # each piece of CMU's counts so often: 68 pieces, 960 of the library
SMALL = TokenizerConfig(codes=512, code_width=128, width=160)
SMALL_T5: dict[str, Any] = {
    "d_model": 192, "d_kv": 48, "d_ff": 448, "num_layers": 3, "num_decoder_layers": 3, "num_heads": 4,
    "relative_attention_num_buckets": 32, "feed_forward_proj": "gated-gelu", "dropout_rate": 0.1,
    "tie_word_embeddings": False,
}  # fmt: skip
ROOT, ROOT_COUNTS = slice(0, 4), 5.0  # else four channels of 263 are all but ignored: turns came out by a third
GROUPS = (
    slice(0, 1), slice(1, 3), slice(3, 4), slice(4, 67), ROTATIONS, VELOCITIES, CONTACTS,
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class MotiongptRecipe:
    """Hyperparameters of the whole training."""

    tokenizer: TokenizerRecipe = field(default_factory=lambda: TokenizerRecipe(steps=7000, batch=24, frames=48))
    language: LanguageRecipe = field(default_factory=lambda: LanguageRecipe(steps=3500, batch=32))
    seeds: range = TRAIN_SEEDS
    shape: TokenizerConfig = SMALL


def statistics(examples: list[SentenceExample]) -> tuple[Float[Array, " feature"], Float[Array, " feature"]]:
    """Mean of each feature, and one standard deviation per group of features, as HumanML3D defines it.

    That of the root's channels is divided by 5, so that they have more weight; MotionGPT's own std divides by 25.
    """
    every = np.concatenate([example.features for example in examples])
    mean, std = every.mean(axis=0), every.std(axis=0)
    for group in GROUPS:
        std[group] = max(float(std[group].mean()), 1e-4)
    std[ROOT] /= ROOT_COUNTS
    return mean, std


def train(data: Path, work: Path, recipe: MotiongptRecipe | None = None) -> dict[str, Any]:
    """Trains tokenizer and language model; returns the arguments of `save_weights`.

    Without CMU's files in `data` the library alone is used.
    """
    recipe = recipe or MotiongptRecipe()
    work.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(1)
    began = time.process_time()
    examples = list(library_examples(recipe.seeds))
    cmu = list(cmu_examples(data, "train")) if data.is_dir() else []
    examples += CMU_COPIES * cmu
    mean, std = statistics(examples)
    normalised = [(example.features - mean) / std for example in examples]
    tokenizer = train_tokenizer(normalised, recipe.shape, recipe.tokenizer, work / "tokenizer.pt")
    codes = [_codes(tokenizer, motion) for motion in normalised]
    words = train_words([example.sentence for example in examples])
    plain = plain_words(words)
    first = add_motion_tokens(words, recipe.shape.codes)
    pairs = [
        (words(example.sentence.lower()).input_ids, motion) for example, motion in zip(examples, codes, strict=True)
    ]
    sizes = {**SMALL_T5, "vocab_size": len(words)}
    language = train_language(pairs, sizes, first, recipe.shape.codes, recipe.language, work / "language.pt")
    return {
        "tokenizer": tokenizer, "language": language, "mean": mean, "std": std, "vocabulary": plain,
        "cpu_s": time.process_time() - began,
        "examples": {"library": len(examples) - CMU_COPIES * len(cmu), "cmu": len(cmu)},
    }  # fmt: skip


def _codes(tokenizer: MotionTokenizer, motion: Float[Array, "frame feature"]) -> list[int]:
    with torch.inference_mode():
        return tokenizer.encode(torch.from_numpy(motion[None].astype(np.float32)))[0].tolist()


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, default=Path("shared/data"), help="folder of real data (CMU's motions)"
    )
    parser.add_argument(
        "--work", type=Path, default=Path("build/motiongpt"), help="where an interrupted training continues"
    )
    parser.add_argument(
        "--weights", type=Path, default=Path("weights/motiongpt_small.safetensors"), help="file to write"
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    made = train(options.data, options.work)
    save_weights(
        options.weights, tokenizer=made["tokenizer"], language=made["language"], mean=made["mean"], std=made["std"],
        vocabulary=made["vocabulary"], half=True,
    )  # fmt: skip
