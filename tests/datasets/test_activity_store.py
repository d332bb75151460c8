"""Damage of a labelled set is noticed, and nothing of it is trained on."""

import shutil
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.activity_store import read_activity_set
from tests.datasets.conftest import activity_set  # noqa: F401  (a fixture)

STORE = "sequences.zarr"
VICTIMS = [f"{STORE}/label/c/0", f"{STORE}/joints_m/c/0/0/0/0", "leaks.json", f"{STORE}/zarr.json"]


@pytest.mark.parametrize("victim", VICTIMS)
@pytest.mark.parametrize("how", ["deleted", "flipped"])
def test_damage_is_refused_when_opened(activity_set: Path, tmp_path: Path, victim: str, how: str):  # noqa: F811
    copy = tmp_path / "set"
    shutil.copytree(activity_set, copy)
    _damage(copy / victim, how)
    with pytest.raises(InputError):
        read_activity_set(copy)


@pytest.mark.parametrize("how", ["deleted", "flipped"])
def test_a_damaged_signal_is_refused_when_read(activity_set: Path, tmp_path: Path, how: str):  # noqa: F811
    copy = tmp_path / "set"
    shutil.copytree(activity_set, copy)
    chunk = next(file for file in sorted((copy / "sequences.zarr/iq/c/1").rglob("*")) if file.is_file())
    _damage(chunk, how)
    stored = read_activity_set(copy)
    assert stored.cube(1).values.any()
    with pytest.raises(InputError, match="mmweaver dataset"):
        stored.cube(17)  # in the second shard


def _damage(file: Path, how: str) -> None:
    if how == "deleted":
        file.unlink()
        return
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 4
    file.write_bytes(bytes(data))
