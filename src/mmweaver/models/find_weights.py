"""Where weights come from: a file, a folder of `mmweaver train`, or a repository on the Hub."""

import re
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.models.weights import WEIGHTS_FILE

HUB_NAME = re.compile(r"[A-Za-z0-9][\w.-]*/[A-Za-z0-9][\w.-]*")


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
    return _of_hub(str(source), revision)


def _of_hub(name: str, revision: str | None) -> Path:
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
