"""The text tokenizer of the language model."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from transformers import PreTrainedTokenizerBase

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
