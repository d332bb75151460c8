"""Optional packages, by the extra that installs them.

Silences logging while the Hub client reports every retry; the user gets one error line instead.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from mmweaver.core.errors import InputError


@contextmanager
def hub_log_off() -> Iterator[None]:
    """Context in which all logging is suppressed."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


# module -> package for each extra named in error messages; a test compares this with pyproject.toml and all imports
EXTRAS: dict[str, dict[str, str]] = {
    "capture": {"av": "av", "rosbags": "rosbags", "zstandard": "zstandard"},
    "codecs": {"blosc2": "blosc2", "imagecodecs": "imagecodecs", "tensorly": "tensorly"},
    "cluster": {"ray": "ray", "zarr": "zarr"},
    "completion": {"shtab": "shtab"},
    "dataset": {"numcodecs": "numcodecs", "zarr": "zarr"},
    "evaluate": {"sklearn": "scikit-learn"},
    "export": {"av": "av", "foxglove": "foxglove-sdk", "rosbags": "rosbags", "xarray": "xarray", "zarr": "zarr"},
    "hdf5": {"h5py": "h5py"},
    "mesh": {"trimesh": "trimesh"},
    "notebook": {"anywidget": "anywidget"},
    "phone": {"av": "av", "pillow_heif": "pillow-heif"},
    "pretrained": {"transformers": "transformers"},
    "rerun": {"rerun": "rerun-sdk"},
    "studio": {
        "python_multipart": "python-multipart",
        "starlette": "starlette",
        "uvicorn": "uvicorn",
        "websockets": "websockets",
    },
    "training": {"accelerate": "accelerate", "tensorboard": "tensorboard", "zarr": "zarr"},
    "weaver": {"huggingface_hub": "huggingface-hub", "zarr": "zarr"},
    "xarray": {"xarray": "xarray"},
}


def need(extra: str, what: str, *modules: str) -> None:
    """Checks that the packages of an extra are installed.

    Args:
        extra: Name of the extra.
        what: Feature that needs them, the subject of the error message.
        *modules: Modules that are needed. Default: all of the extra.

    Raises:
        InputError: If one is missing, with the command that installs it.
    """
    for module in modules or EXTRAS[extra]:
        if not is_installed(module):
            raise InputError(
                f"{what} needs the package {EXTRAS[extra][module]}; install it with: pip install 'mmweaver[{extra}]'"
            )


def is_installed(module: str) -> bool:
    """Whether a module can be found, without importing it."""
    try:
        return find_spec(module) is not None
    except ValueError:  # in sys.modules without a spec
        return True
