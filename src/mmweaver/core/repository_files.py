"""Files that are part of a repository clone but, because of their size, not of the installed package."""

from pathlib import Path

from mmweaver.core.errors import InputError

WEIGHTS = Path(__file__).resolve().parents[3] / "weights"


def repository_file(name: str, what: str, otherwise: str) -> Path:
    """Locates a file in the weights/ folder of the repository.

    Args:
        name: File name, such as "motiongpt_small.safetensors".
        what: Subject of the error message.
        otherwise: Advice of the error message.

    Returns:
        Path of the file.

    Raises:
        InputError: If mmweaver runs without a clone.
    """
    path = WEIGHTS / name
    if not path.is_file():
        raise InputError(f"{what} is in the repository, not in the installed package; {otherwise}")
    return path
