"""Files that a clone of the repository holds and the installed package does not, for their size."""

from pathlib import Path

from mmweaver.core.errors import InputError

WEIGHTS = Path(__file__).resolve().parents[3] / "weights"


def repository_file(name: str, what: str, otherwise: str) -> Path:
    """Place of a file, such as "motiongpt_small.safetensors", in the folder weights/ of the repository.

    Raises InputError where mmweaver runs without a clone: `what` is the subject of its line, `otherwise` what to do.
    """
    path = WEIGHTS / name
    if not path.is_file():
        raise InputError(f"{what} is in the repository, not in the installed package; {otherwise}")
    return path
