"""Saving a MotionGPT: as a self-contained safetensors file of this project, or in the published format; its words."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.tensor_files import write_tensors
from mmweaver.motion.motiongpt.checkpoint import LANGUAGE, MEAN, STD, VAE, VOCABULARY
from mmweaver.motion.motiongpt.language_model import wrapped
from mmweaver.motion.motiongpt.tokenizer import MotionTokenizer

if TYPE_CHECKING:
    from transformers import PreTrainedTokenizerBase, T5ForConditionalGeneration

SAME = ("encoder.embed_tokens.weight", "decoder.embed_tokens.weight")  # of shared.weight


def state_of(tokenizer: MotionTokenizer, language: "T5ForConditionalGeneration") -> dict[str, Tensor]:
    """All tensors under their published names."""
    state = {VAE + name: value.detach() for name, value in tokenizer.state_dict().items()}
    return state | {LANGUAGE + name: value.detach() for name, value in language.state_dict().items()}


def save_weights(
    path: Path,
    *,
    tokenizer: MotionTokenizer,
    language: "T5ForConditionalGeneration",
    mean: Float[np.ndarray, " feature"],
    std: Float[np.ndarray, " feature"],
    vocabulary: str,
    half: bool = False,
) -> None:
    """One safetensors file with weights, mean, std and vocabulary; with `half` the weights as float16."""
    state = {name: value for name, value in state_of(tokenizer, language).items() if not name.endswith(SAME)}
    state = {name: (value.half() if half else value).contiguous().clone() for name, value in state.items()}
    state |= {MEAN: torch.from_numpy(mean.astype(np.float32)), STD: torch.from_numpy(std.astype(np.float32))}
    write_tensors(path, state, {VOCABULARY: vocabulary})


def save_published(path: Path, tokenizer: MotionTokenizer, language: "T5ForConditionalGeneration") -> None:
    """A torch archive in MotionGPT's layout: everything under `state_dict`."""
    with atomic_file(path) as temporary:
        torch.save({"state_dict": state_of(tokenizer, language)}, temporary)


def train_words(sentences: list[str]) -> "PreTrainedTokenizerBase":
    """A tokenizer of whole words, for a small model."""
    from tokenizers import Tokenizer, models, normalizers, pre_tokenizers

    normal = normalizers.Lowercase()
    split = pre_tokenizers.Whitespace()
    known = {word for sentence in sentences for word, _ in split.pre_tokenize_str(normal.normalize_str(sentence))}
    names = ["<pad>", "</s>", "<unk>", *sorted(known)]
    model = Tokenizer(models.WordLevel({name: k for k, name in enumerate(names)}, unk_token="<unk>"))
    model.normalizer, model.pre_tokenizer = normal, split
    return wrapped(model.to_str())


def plain_words(words: "PreTrainedTokenizerBase") -> str:
    """The tokenizer as JSON, to be stored with the weights."""
    backend: Any = words
    return backend.backend_tokenizer.to_str()
