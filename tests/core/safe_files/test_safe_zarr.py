"""What a Zarr group promises is held against its chunk files before anything is read."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_zarr import ZarrFolder, open_zarr
from mmweaver.datasets.zarr_arrays import put_array, put_sequences

PLACES = np.arange(60.0).reshape(4, 5, 3)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr("mmweaver.datasets.zarr_arrays.SHARD_BYTES", 60)  # two of these sequences
    group = zarr.open_group(tmp_path / "set", mode="w")
    put_array(group, "place_m", PLACES, ("sequence", "frame", "axis"))
    put_sequences(group, "iq", "float16", PLACES.shape, ("sequence", "frame", "axis"), PLACES.astype("f2"))
    put_array(group, "seed", np.arange(4), ("sequence",))
    group.attrs.update({"kind": "office", "text": ["a", "b"]})
    return tmp_path / "set"


def test_numbers_rows_and_attributes_come_back(store: Path):
    found = open_zarr(store)
    assert np.array_equal(found.numbers("place_m", ("sequence", "frame", 3)), PLACES)
    assert np.array_equal(found.row("iq", 3, (5, 3)), PLACES[3])
    assert found.rows_a_file("iq") == 2
    assert found.attr("kind", str) == "office"
    assert found.words("text") == ("a", "b")
    assert "seed" in found
    assert "empty_iq" not in found
    assert found.promise("place_m").promised == PLACES.nbytes


@pytest.mark.parametrize(
    ("read", "message"),
    [
        (lambda found: found.numbers("place_m", ("sequence", "frame", 2)), "it must be"),
        (lambda found: found.numbers("place_m", ("sequence", "frame", 3), high=10), "outside"),
        (lambda found: found.numbers("none", ("sequence",)), "has no none"),
        (lambda found: found.numbers("seed", ("sequence",), kinds="f"), "is of type int64"),
        (lambda found: found.row("iq", 4, (5, 3)), "no element 4"),
        (lambda found: found.texts("seed", "sequence"), "texts are needed"),
        (lambda found: found.attr("kind", int), "its kind is 'office'"),
        (lambda found: found.words("kind"), "its kind is 'office'"),
        (lambda found: found.group("place_m"), "no Zarr group"),
    ],
)
def test_what_is_not_as_asked_is_refused(store: Path, read: Callable[[ZarrFolder], Any], message: str):
    with pytest.raises(InputError, match=message):
        read(open_zarr(store))


def changed(store: Path, name: str, **values: Any) -> None:
    file = store / name / "zarr.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | values))


def chunks(*lengths: int) -> dict[str, Any]:
    return {"chunk_grid": {"name": "regular", "configuration": {"chunk_shape": list(lengths)}}}


@pytest.mark.parametrize(
    "values",
    [
        {"shape": [2**40, 5, 3]},
        {"shape": [2**40, 2**40, 2**40], **chunks(2**40, 2**40, 2**40)},
        {"shape": [10**6, 5, 3], **chunks(1, 5, 3)},
        {"shape": [10**12, 5, 3], **chunks(1, 5, 3)},
        {"shape": [4.0, 5, 3]}, {"shape": [-4, 5, 3]}, {"shape": "4"}, chunks(0, 5, 3), chunks(4, 5), chunks(9, 5, 3),
        {"data_type": "string"}, {"data_type": "object"}, {"data_type": "r8"}, {"data_type": 3},
        {"codecs": [{"name": "bytes"}, {"name": "gzip"}]}, {"codecs": []}, {"codecs": [{"name": "numcodecs.pickle"}]},
        {"chunk_key_encoding": {"name": "v2"}}, {"node_type": "x"}, {"zarr_format": 2},
    ],
)  # fmt: skip
def test_metadata_that_promises_what_no_file_holds_is_refused(store: Path, values: dict[str, Any]):
    changed(store, "place_m", **values)
    with pytest.raises(InputError):
        open_zarr(store).numbers("place_m", ("sequence", "frame", 3))


@pytest.mark.parametrize(
    "values", [{"data_type": "string"}, {"data_type": "numpy.datetime64"}, {"data_type": "M8[s]"},
               {"shape": [1] * 40, **chunks(*[1] * 40)}]
)  # fmt: skip
def test_an_array_of_another_kind_is_refused_before_any_array_is_read(store: Path, values: dict[str, Any]):
    changed(store, "place_m", **values)
    with pytest.raises(InputError, match="place_m"):
        open_zarr(store)


@pytest.mark.parametrize(("megabytes", "is_read"), [(8, True), (100, False)])
def test_few_bytes_may_become_some_megabytes_but_not_a_hundred(tmp_path: Path, megabytes: int, is_read: bool):
    """Zeros compress by more than any ratio that is allowed: small arrays may, large ones promise too much."""
    group = zarr.open_group(tmp_path / "zeros", mode="w")
    array = group.create_array("zeros", shape=(megabytes, 125_000), chunks=(1, 125_000), dtype="f8", fill_value=1.0)
    array[:] = 0.0
    if is_read:
        assert not open_zarr(tmp_path / "zeros").row("zeros", 0, (125_000,)).any()
    else:
        with pytest.raises(InputError, match=f"say {megabytes}000000 bytes"):
            open_zarr(tmp_path / "zeros")


def test_a_chunk_that_is_missing_and_filled_with_nan_is_refused(store: Path):
    changed(store, "place_m", fill_value="NaN")
    (store / "place_m" / "c" / "0" / "0" / "0").unlink()
    with pytest.raises(InputError, match=r"place_m.*finite"):
        open_zarr(store).numbers("place_m", ("sequence", "frame", 3))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no FIFO here")
def test_a_chunk_that_is_a_fifo_is_refused_at_once(store: Path):
    chunk = store / "place_m" / "c" / "0" / "0" / "0"
    chunk.unlink()
    os.mkfifo(chunk)
    with pytest.raises(InputError, match="a FIFO"):
        open_zarr(store)


def test_a_folder_that_is_no_group_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match=r"zarr\.json"):
        open_zarr(tmp_path)
