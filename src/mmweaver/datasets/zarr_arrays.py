"""Arrays of a data set's Zarr groups: every chunk is written, with a CRC-32C."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError

UNITS = {
    "iq": "1 (times iq_scale: sqrt(mW))", "iq_scale": "sqrt(mW)", "joints_m": "m", "joint_velocity_mps": "m/s",
    "photo_depth_m": "m", "range": "m", "radial_velocity": "m/s", "frame_time": "s",
    "antenna_position_m": "m", "empty_iq": "sqrt(mW)",
}  # fmt: skip


def zarr_module() -> Any:
    """The zarr module, imported lazily. Raises InputError where it is not installed."""
    try:
        import zarr
    except ImportError as error:
        raise InputError("data sets need Zarr; install it with: pip install 'mmweaver[dataset]'") from error
    return zarr


def put_array(
    group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...], *, packing: Any = None, sequences: int = 0
) -> None:
    """Writes one array as one chunk, or, with `sequences`, one chunk a sequence in shards of at most so many.

    `packing`: the codec of its bytes (default Zstandard). Chunks of nothing but zeros are written too, so that a file
    that is missing is damage, which Zarr itself takes for zeros.
    """
    from zarr.codecs import Crc32cCodec, ZstdCodec

    values = np.ascontiguousarray(values)
    options: dict[str, Any] = {"chunks": values.shape if values.size else (1,) * values.ndim}
    if sequences:
        rest = values.shape[1:]
        options = {"chunks": (1, *rest), "shards": (min(sequences, len(values)), *rest)}
        if len(values) % options["shards"][0]:
            options["shards"] = (1, *rest)
    array = group.create_array(
        name, shape=values.shape, dtype=values.dtype, dimension_names=dimensions, overwrite=True,
        compressors=[packing or ZstdCodec(), Crc32cCodec()], config={"write_empty_chunks": True}, **options,
    )  # fmt: skip
    array[...] = values
    unit = UNITS.get(name, "m" if name.endswith("_m") else "")
    if unit:
        array.attrs["units"] = unit


def consolidate(store: Path) -> None:
    """Collects the metadata of all arrays in the group's own, so that xarray opens it without a word or a search."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # version 3 of Zarr has no chapter on it yet; readers without it ignore it
        zarr_module().consolidate_metadata(store)


def put_texts(group: Any, name: str, texts: Sequence[str]) -> None:
    """Writes one text for each sequence."""
    array = group.create_array(name, shape=(len(texts),), dtype="string", dimension_names=("sequence",))
    array[...] = np.asarray(texts, dtype=object)
