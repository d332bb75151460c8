"""Sources of weights: a file, a folder of `mmweaver train` or a repository on the Hub; and publishing them."""

import re
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import hub_log_off, need
from mmweaver.models.weights import WEIGHTS_FILE, read_card

HUB_NAME = re.compile(r"[A-Za-z0-9][\w.-]*/[A-Za-z0-9][\w.-]*")
CARD_FILE = "README.md"
ALL_WEIGHTS = "weights*.safetensors"  # pose networks are several


def find_weights(source: str | Path, *, revision: str | None = None) -> Path:
    """Finds a weight file; one on the Hub is downloaded once and kept in the Hub's own cache.

    Args:
        source: Weight file, folder of `mmweaver train`, or name on the Hub.
        revision: Branch, tag or commit on the Hub.

    Returns:
        Path of the weight file.

    Raises:
        InputError: If it is not found.
    """
    path = Path(source)
    if path.is_dir():
        file = path / WEIGHTS_FILE
        if not file.is_file():
            raise InputError(f"{path} holds no {WEIGHTS_FILE}; give a folder of mmweaver train, or a weight file")
        return file
    if path.is_file():
        return path
    if not HUB_NAME.fullmatch(str(source)) or path.suffix == ".safetensors":
        raise InputError(f"{source} does not exist; give a .safetensors file that mmweaver train wrote, or its folder")
    return _download(str(source), revision)


def _download(name: str, revision: str | None) -> Path:
    need("weaver", f"{name} is no file here; a name on the Hub", "huggingface_hub")
    from huggingface_hub import hf_hub_download

    try:
        return Path(hf_hub_download(name, WEIGHTS_FILE, revision=revision))
    except Exception as error:  # no network, no such repository, no such file: as many kinds of errors
        reason = (str(error).strip().splitlines() or [type(error).__name__])[0][:120]
        raise InputError(
            f"{name} is no file here and cannot be had from the Hub ({reason}); where there is a network:"
            f" hf download {name} --local-dir DIR, then give DIR"
        ) from None


def push_to_hub(
    source: str | Path,
    repo_id: str,
    *,
    card: str | Path | None = None,
    private: bool = False,
    revision: str | None = None,
) -> str:
    """Uploads weights with their model card, and nothing else, to a model repository, which is created if necessary.

    Uses the account logged in by `hf auth login`, or the token in HF_TOKEN.

    Args:
        source: Folder of `mmweaver train`, or one weight file, which is uploaded as weights.safetensors.
        repo_id: Name of the repository, such as "me/my-room".
        card: Model card (default: README.md next to the weights).
        private: Whether a newly created repository is private.
        revision: Branch to upload to (default: main).

    Returns:
        Address of the commit.

    Raises:
        InputError: For weights that are damaged or not of mmWeaver, for a card that is missing, unreadable or states
            another licence than the weights, and if the Hub refuses.
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
    """Checks a model card; InputError if it is missing, unreadable, or contradicts the weights."""
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
