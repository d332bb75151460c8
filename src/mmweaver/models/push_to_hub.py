"""Publishes weights on the Hugging Face Hub, where `Weaver.from_pretrained` and `--weights NAME` find them."""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.hub_log import hub_log_off
from mmweaver.core.optional_packages import need
from mmweaver.models.weights import WEIGHTS_FILE, read_card

CARD_FILE = "README.md"
ALL_WEIGHTS = "weights*.safetensors"  # pose networks are several


def push_to_hub(
    source: str | Path, repo_id: str, *, card: str | Path | None = None, private: bool = False,
    revision: str | None = None,
) -> str:  # fmt: skip
    """Uploads weights with their model card, and nothing else, to a model repository, which is made if it is not there.

    Who uploads is who logged in with `hf auth login`, or the owner of the token in HF_TOKEN.

    Args:
        source: a folder of `mmweaver train`, or one weight file, which is called weights.safetensors there.
        repo_id: name of the repository, such as "me/my-room".
        card: the model card (default: README.md next to the weights).
        private: whether a repository that is made now is private.
        revision: branch to upload to (default: main).

    Returns:
        The address of the commit.

    Raises:
        InputError: for weights that are damaged or not of mmWeaver, for a card that is missing, cannot be read or names
            another licence than the weights, and where the Hub refuses.
    """
    need("weaver", "publishing on the Hub", "huggingface_hub")
    from huggingface_hub import HfApi

    source = Path(source)
    files = [source] if source.is_file() else sorted(source.glob(ALL_WEIGHTS))
    if not files:
        raise InputError(f"{source} holds no {WEIGHTS_FILE}; give a folder of mmweaver train, or a weight file")
    page = Path(card) if card is not None else files[0].parent / CARD_FILE
    _check_card(page, {read_card(file).licence for file in files})
    with TemporaryDirectory() as folder:
        for file in files:
            shutil.copyfile(file, Path(folder) / (WEIGHTS_FILE if source.is_file() else file.name))
        shutil.copyfile(page, Path(folder) / CARD_FILE)
        try:
            with hub_log_off():
                api = HfApi(library_name="mmweaver")
                api.create_repo(repo_id, private=private, exist_ok=True)
                return str(api.upload_folder(repo_id=repo_id, folder_path=folder, revision=revision))
        except Exception as error:  # no network, no token, no such owner: as many kinds of errors
            reason = " ".join(str(error).split())[:120] or type(error).__name__
            raise InputError(f"{repo_id} cannot be written on the Hub ({reason}); log in with: hf auth login") from None


def _check_card(page: Path, licences: set[str]) -> None:
    """Raises InputError for a model card that is missing, cannot be read, or contradicts the weights."""
    from huggingface_hub import ModelCard

    if not page.is_file():
        raise InputError(f"{page} is missing: weights are published with a model card; give one by card=")
    try:
        data: Any = ModelCard.load(page).data
    except Exception as error:  # of YAML and of the Hub's card classes
        reason = " ".join(str(error).split())[:120]
        raise InputError(f"{page} has no front matter that the Hub can read ({reason}); mend it") from None
    said = str(data.license or "no licence")
    if {said} != {licence.lower() for licence in licences}:
        raise InputError(f"{page} names {said}, the weights {', '.join(sorted(licences))}; name the same licence")
