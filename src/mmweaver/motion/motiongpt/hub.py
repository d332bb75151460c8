"""Finds a checkpoint by the name of its repository on the Hugging Face Hub."""

import re
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.hub_log import hub_log_off

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
