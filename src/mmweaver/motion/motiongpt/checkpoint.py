"""Reading a MotionGPT checkpoint: nothing in it is executed, tensors are checked by name, sizes inferred from them.

Reference: MotionGPT's checkpoint `motiongpt_s3_h3d.tar`: a torch archive whose `state_dict` holds `vae.*` and
`lm.language_model.*` (docs/evidence/motiongpt.md).

Finds a checkpoint by the name of its repository on the Hugging Face Hub.
"""

import re
from pathlib import Path

from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import hub_log_off
from mmweaver.core.safe_files import safe_tensors
from mmweaver.motion.motiongpt.tokenizer import TokenizerConfig

PUBLISHED = "OpenMotionLab/MotionGPT-base"
CHECKPOINT, SMALL = "motiongpt_s3_h3d.tar", "motiongpt_small.safetensors"


def looks_like_hub(name: str) -> bool:
    """Whether a name has the form owner/name and is not an existing path.

    Args:
        name: Name or path given by the user.

    >>> looks_like_hub("OpenMotionLab/MotionGPT-base"), looks_like_hub("weights/motiongpt.tar")
    (True, False)
    """
    shaped = re.fullmatch(r"[\w.-]+/[\w.-]+", name) is not None
    return shaped and not Path(name).exists() and not Path(name).parent.is_dir() and Path(name).suffix == ""


def published_checkpoint(name: str) -> Path:
    """Downloads the published or the small checkpoint of a repository once, into the Hub's cache.

    Args:
        name: Repository as owner/name.

    Returns:
        Path in the cache.

    Raises:
        InputError: If it cannot be fetched.
    """
    from huggingface_hub import hf_hub_download
    from huggingface_hub.errors import EntryNotFoundError

    try:
        with hub_log_off():
            try:
                return Path(hf_hub_download(repo_id=name, filename=CHECKPOINT))
            except EntryNotFoundError:
                return Path(hf_hub_download(repo_id=name, filename=SMALL))
    except Exception as error:
        why = " ".join(str(error).split())[:80]
        raise InputError(
            f"{CHECKPOINT} or {SMALL} of {name} cannot be fetched from the Hub ({why}); download it yourself and give"
            " its path"
        ) from None


VAE, LANGUAGE = "vae.", "lm.language_model."
MEAN, STD, VOCABULARY = "meta.mean", "meta.std", "vocabulary"  # only in this project's own files
NO_CHECKPOINT = (
    "cut short, damaged, or no torch checkpoint of tensors alone ({reason}); if you trust it, save its state_dict alone"
    " with torch.save and give that file"
)
State = dict[str, Tensor]


def read_checkpoint(path: Path) -> tuple[State, dict[str, str]]:
    """Reads all tensors of a checkpoint.

    Args:
        path: safetensors file, or torch archive of tensors.

    Returns:
        Tensors by name, and the metadata of a safetensors file.

    Raises:
        InputError: If the file is missing or holds anything else.
    """
    if not path.is_file():
        raise InputError(f"there is no checkpoint {path}; give the file of MotionGPT, or a folder that holds it")
    if path.suffix == ".safetensors":
        return safe_tensors.read_tensors(path)
    # The published file is a torch archive, of which only tensors and plain values are read.
    content = safe_tensors.read_checkpoint(path, what=NO_CHECKPOINT)
    state = content.get("state_dict", content) if isinstance(content, dict) else content
    if not isinstance(state, dict) or not all(isinstance(value, Tensor) for value in state.values()):
        raise InputError(f"{path} holds no state_dict of tensors; it is no MotionGPT checkpoint")
    safe_tensors.check_finite(path, state)
    return {str(name): value for name, value in state.items()}, {}


def parts_of(state: State, path: Path) -> tuple[State, State]:
    """Splits the tensors into tokenizer and language model, without those of metrics and losses.

    Args:
        state: Tensors of the checkpoint by name.
        path: Checkpoint, for error messages.

    Returns:
        Tensors of the tokenizer and of the language model, without their prefixes.

    Raises:
        InputError: If either is missing.
    """
    vae = {name.removeprefix(VAE): value for name, value in state.items() if name.startswith(VAE)}
    language = {name.removeprefix(LANGUAGE): value for name, value in state.items() if name.startswith(LANGUAGE)}
    if not vae or not language:
        lacks = [prefix + "*" for prefix, part in ((VAE, vae), (LANGUAGE, language)) if not part]
        few = ", ".join(list(state)[:3]) or "nothing"
        raise InputError(f"{path} is no MotionGPT checkpoint: it has no {' and no '.join(lacks)}, but {few}")
    return vae, language


def tokenizer_config(vae: State, path: Path) -> TokenizerConfig:
    """Infers the sizes of the tokenizer from its tensors.

    Args:
        vae: Tensors of the tokenizer.
        path: Checkpoint, for error messages.

    Raises:
        InputError: If tensors are missing or have unexpected shapes.
    """
    first, book = _need(vae, path, VAE, "encoder.model.0.weight", "quantizer.codebook")
    blocks = {int(name.split(".")[2]) for name in vae if name.startswith("encoder.model.") and ".model." in name[14:]}
    depth = {int(name.split(".")[5]) for name in vae if name.startswith("encoder.model.2.1.model.")}
    if first.ndim != 3 or book.ndim != 2 or not blocks or not depth:
        raise InputError(f"{path}: the motion tokenizer's tensors have other shapes than MotionGPT's")
    return TokenizerConfig(
        features=first.shape[1],
        width=first.shape[0],
        codes=book.shape[0],
        code_width=book.shape[1],
        halvings=len(blocks),
        depth=max(depth) + 1,
    )


def _need(state: State, path: Path, prefix: str, *names: str) -> list[Tensor]:
    missing = [prefix + name for name in names if name not in state]
    if missing:
        raise InputError(f"{path} lacks {', '.join(missing)}; it is incomplete, download it again")
    return [state[name] for name in names]


def t5_sizes(language: State, path: Path) -> dict[str, int | str | bool]:
    """Infers the sizes of the T5 from its tensors.

    Args:
        language: Tensors of the language model.
        path: Checkpoint, for error messages.

    Returns:
        Arguments of `transformers.T5Config`.

    Raises:
        InputError: If tensors are missing or have unexpected shapes.
    """
    block = "encoder.block.0.layer.0.SelfAttention."
    shared, bias, query = _need(
        language, path, LANGUAGE, "shared.weight", f"{block}relative_attention_bias.weight", f"{block}q.weight"
    )
    gated = "encoder.block.0.layer.1.DenseReluDense.wi_0.weight" in language
    wide = f"encoder.block.0.layer.1.DenseReluDense.{'wi_0' if gated else 'wi'}.weight"
    (inner,) = _need(language, path, LANGUAGE, wide)
    if shared.ndim != 2 or bias.ndim != 2 or query.ndim != 2 or not bias.shape[1] or query.shape[0] % bias.shape[1]:
        raise InputError(f"{path}: the language model's tensors have other shapes than a T5's")
    layers = {
        side: 1 + max((int(name.split(".")[2]) for name in language if name.startswith(f"{side}.block.")), default=-1)
        for side in ("encoder", "decoder")
    }
    return {
        "vocab_size": shared.shape[0],
        "d_model": shared.shape[1],
        "num_heads": bias.shape[1],
        "relative_attention_num_buckets": bias.shape[0],
        "d_kv": query.shape[0] // bias.shape[1],
        "d_ff": inner.shape[0],
        "num_layers": layers["encoder"],
        "num_decoder_layers": layers["decoder"],
        "feed_forward_proj": "gated-gelu" if gated else "relu",
        "tie_word_embeddings": "lm_head.weight" not in language,
    }


def check_state(given: State, wanted: State, prefix: str, path: Path) -> None:
    """Checks that tensors are complete and have the expected shapes.

    Args:
        given: Tensors of the checkpoint.
        wanted: Tensors of the model.
        prefix: Prefix of the names in error messages.
        path: Checkpoint, for error messages.

    Raises:
        InputError: If tensors are missing or have other shapes, naming the first few.
    """
    missing = [prefix + name for name in wanted if name not in given]
    if missing:
        raise InputError(f"{path} lacks {_few(missing)}; it is incomplete or of another model")
    other = [
        f"{prefix}{name} is {tuple(given[name].shape)} and not {tuple(value.shape)}"
        for name, value in wanted.items()
        if given[name].shape != value.shape
    ]
    if other:
        raise InputError(f"{path}: {_few(other)}; it is of another model")


def _few(names: list[str], most: int = 3) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
