"""Where weights come from, a file, a folder of `mmweaver train` or a repository on the Hub, and how they get there."""

import re
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.hub_log import hub_log_off
from mmweaver.core.optional_packages import need
from mmweaver.models.weights import WEIGHTS_FILE, read_card

HUB_NAME = re.compile(r"[A-Za-z0-9][\w.-]*/[A-Za-z0-9][\w.-]*")
CARD_FILE = "README.md"
ALL_WEIGHTS = "weights*.safetensors"  # pose networks are several


def find_weights(source: str | Path, *, revision: str | None = None) -> Path:
    """The weight file that is meant; a Hub name is fetched once and kept in the Hub's own cache.

    `revision`: a branch, tag or commit on the Hub. Raises InputError where nothing is there, or the Hub has it not.
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
