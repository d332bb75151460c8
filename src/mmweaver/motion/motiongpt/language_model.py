"""The language model of MotionGPT: a T5 whose vocabulary has 515 motion tokens after the words.

`<motion_id_0>` ... `<motion_id_511>` are the codes; 512 begins a motion, 513 ends it, 514 is a mask.

The text tokenizer of the language model.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import torch
from jaxtyping import Float, Int
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

if TYPE_CHECKING:
    from transformers import PreTrainedTokenizerBase, T5ForConditionalGeneration


HUB_WORDS = "google/flan-t5-base"
WORD_FILES = ("tokenizer.json", "spiece.model")


def load_words(folder: Path | None) -> "PreTrainedTokenizerBase":
    """Loads the text tokenizer of flan-t5-base.

    Args:
        folder: Folder with tokenizer.json or spiece.model; None takes the Hub or its cache.

    Raises:
        InputError: If it cannot be read.
    """
    from transformers import AutoTokenizer

    try:
        words: Any = AutoTokenizer.from_pretrained(str(folder) if folder is not None else HUB_WORDS)
        return words
    except Exception:
        where = folder if folder is not None else f"the Hub ({HUB_WORDS})"
        raise InputError(
            f"the text tokenizer cannot be read from {where}; put the tokenizer.json of {HUB_WORDS} next to the"
            " checkpoint"
        ) from None


def wrapped(description: str) -> "PreTrainedTokenizerBase":
    """A tokenizer from its JSON; texts end with </s>, as for T5.

    Args:
        description: Content of tokenizer.json.
    """
    from tokenizers import Tokenizer, processors
    from transformers import PreTrainedTokenizerFast

    model: Any = Tokenizer.from_str(description)
    model.post_processor = processors.TemplateProcessing(single="$A </s>", special_tokens=[("</s>", 1)])
    return PreTrainedTokenizerFast(tokenizer_object=model, pad_token="<pad>", eos_token="</s>", unk_token="<unk>")


def unknown_words(words: "PreTrainedTokenizerBase", text: str) -> tuple[str, ...]:
    """Words of a text that are not in the vocabulary; a subword tokenizer has none.

    Args:
        words: Text tokenizer.
        text: The text.
    """
    if words.unk_token_id is None:
        return ()
    found = [word for word in text.split() if words.unk_token_id in words(word).input_ids]
    return tuple(dict.fromkeys(found))


# flan-t5-base with 32,100 words and 515 motion tokens: what the published checkpoint holds.
PUBLISHED_T5: dict[str, Any] = {
    "vocab_size": 32_100 + 515,
    "d_model": 768,
    "d_kv": 64,
    "d_ff": 2048,
    "num_layers": 12,
    "num_decoder_layers": 12,
    "num_heads": 12,
    "feed_forward_proj": "gated-gelu",
    "tie_word_embeddings": False,
}
LONGEST_TEXT_TOKENS = 256


def build_t5(sizes: dict[str, Any]) -> "T5ForConditionalGeneration":
    """A T5 of the given sizes with random weights.

    `tie_word_embeddings` False gives the output words a matrix of their own, as in flan-t5; transformers 5 would share
    one with the input words whatever the configuration.

    Args:
        sizes: Result of `checkpoint.t5_sizes`.

    Raises:
        InputError: If transformers is not installed.
    """
    need("pretrained", "the motion model", "transformers")
    from transformers import T5Config, T5ForConditionalGeneration

    special: dict[str, Any] = {"decoder_start_token_id": 0, "pad_token_id": 0, "eos_token_id": 1}
    config = T5Config(**sizes, **special)
    model = T5ForConditionalGeneration(config)
    if not sizes.get("tie_word_embeddings", True) and model.lm_head.weight is model.shared.weight:
        model.config.tie_word_embeddings = False
        fresh = torch.empty_like(model.shared.weight)
        model.lm_head.weight = torch.nn.Parameter(fresh if fresh.is_meta else fresh.normal_(0, fresh.shape[1] ** -0.5))
    return model


def add_motion_tokens(words: "PreTrainedTokenizerBase", codes: int) -> int:
    """Appends the motion tokens to the vocabulary.

    Args:
        words: Text tokenizer, modified in place.
        codes: Number of motion codes; three special tokens follow them.

    Returns:
        Id of the first motion token.

    Raises:
        InputError: If the tokenizer already has motion tokens in another order.
    """
    names = [f"<motion_id_{k}>" for k in range(codes + 3)]
    words.add_tokens(names)
    first, last = words.convert_tokens_to_ids(names[0]), words.convert_tokens_to_ids(names[-1])
    if not (isinstance(first, int) and isinstance(last, int)) or last - first != codes + 2:
        raise InputError("the text tokenizer already has motion tokens, in another order; give the plain one")
    return first


def sample_codes(
    t5: "T5ForConditionalGeneration",
    text_ids: Int[Tensor, "1 word"],
    *,
    first_motion_id: int,
    codes: int,
    tokens: int | None,
    most_tokens: int,
    seed: int,
    **sampling: Any,
) -> list[int]:
    """Samples motion codes for a text.

    With `tokens`, exactly that many: all other tokens, and an early end, are masked. Without, as many as the model
    generates, up to `most_tokens`, as in the published demo; other tokens are dropped. `sampling`: `temperature`
    (default 1) and `top_k` (default 50). The same seed gives the same codes.
    """
    from transformers import LogitsProcessorList

    rules = LogitsProcessorList()
    if tokens is not None:
        rules.append(_exactly(tokens, first_motion_id, codes))  # type: ignore[arg-type]
    model: Any = t5
    with torch.random.fork_rng(devices=[]), torch.inference_mode():
        torch.manual_seed(seed)
        generated = model.generate(
            input_ids=text_ids,
            attention_mask=torch.ones_like(text_ids),
            max_new_tokens=(tokens if tokens is not None else most_tokens) + 3,
            num_beams=1,
            do_sample=True,
            **({"temperature": 1.0, "top_k": 50} | sampling),
            logits_processor=rules,
        )
    ids = [int(k) - first_motion_id for k in generated[0]]
    begin = ids.index(codes) + 1 if codes in ids else 0
    end = ids.index(codes + 1) if codes + 1 in ids else len(ids)
    return [k for k in ids[begin:end] if 0 <= k < codes]


def _exactly(tokens: int, first: int, codes: int) -> Callable[[Tensor, Tensor], Tensor]:
    """A logits processor that enforces begin, `tokens` codes, end, stop."""

    def rule(ids: Tensor, scores: Float[Tensor, "batch vocabulary"]) -> Float[Tensor, "batch vocabulary"]:
        generated = ids.shape[1] - 1  # the decoder begins with padding
        allowed = torch.zeros(scores.shape[1], dtype=torch.bool)
        if generated == 0:
            allowed[first + codes] = True
        elif generated <= tokens:
            allowed[first : first + codes] = True
        else:
            allowed[first + codes + 1 if generated == tokens + 1 else 1] = True
        return scores.masked_fill(~allowed, -torch.inf)

    return rule
