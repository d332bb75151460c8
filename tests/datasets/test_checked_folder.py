"""Damage of a data set is noticed by whoever reads it, and repaired to the bit by the command that is named."""

import hashlib
import random
import shutil
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_store import read_rooms


def outcome_of_damage(data: Path, rng: random.Random, kind: str) -> str:
    """Damages one file of a data set, reads all of the set, and restores the file: "refused" or what happened else."""
    # request.toml says how the set was made, and nobody reads it back
    file = rng.choice(sorted(path for path in data.rglob("*") if path.is_file() and path.name != "request.toml"))
    whole = file.read_bytes()
    file.unlink()
    if kind == "bit":
        at = rng.randrange(len(whole))
        file.write_bytes(whole[:at] + bytes([whole[at] ^ (1 << rng.randrange(8))]) + whole[at + 1 :])
    elif kind == "cut":
        file.write_bytes(whole[: rng.randrange(len(whole))])
    try:
        read_all(data)
        outcome = "accepted"
    except InputError as error:
        outcome = "refused" if len(str(error)) <= 500 and "\n" not in str(error) else "more than one line"
    except Exception as error:
        outcome = type(error).__name__
    file.write_bytes(whole)
    return outcome


def read_all(data: Path) -> list[str]:
    """Reads everything that training uses; a digest of each room."""
    digests = []
    for room in read_rooms(data):
        digest = hashlib.sha256(repr((room.activity, room.text, room.split, room.person, room.seed)).encode())
        for values in (room.joints_m, room.joint_velocity_mps, room.photo.rgb, room.photo.depth_m, room.static):
            digest.update(values.tobytes())
        if room.photo.classes is not None:
            digest.update(room.photo.classes.index.tobytes())
        if room.geometry is None:
            for index in range(len(room.seed)):
                digest.update(room.cube(index).values.tobytes())
        else:
            digest.update(room.geometry.node_joints_m.tobytes())
            digest.update(repr(room.geometry.room.counts).encode())
            digest.update(repr(room.geometry.photographed.counts).encode())
        digests.append(digest.hexdigest())
    return digests


@pytest.mark.parametrize("geometry_only", [False, True])
def test_no_damage_is_accepted(geometry_only: bool, request: pytest.FixtureRequest, tmp_path: Path):
    """A deleted file, a flipped bit and a cut file, anywhere in the set."""
    whole = request.getfixturevalue("tiny_geometry" if geometry_only else "tiny_signals")
    shutil.copytree(whole, tmp_path / "set")
    rng = random.Random(5)
    outcomes = Counter(outcome_of_damage(tmp_path / "set", rng, ["deleted", "bit", "cut"][k % 3]) for k in range(3))
    assert outcomes == {"refused": 3}


def test_damage_after_the_room_was_opened_is_noticed(tiny_signals: Path, tmp_path: Path):
    """Training reads signals again and again, long after it has opened the set."""
    data = tmp_path / "set"
    shutil.copytree(tiny_signals, data)
    room = read_rooms(data)[0]
    assert np.isfinite(room.cube(0).values).all()
    chunk = room.folder / "iq" / "c" / "0" / "0" / "0" / "0" / "0" / "0"
    chunk.unlink()
    with pytest.raises(InputError, match="is missing"):
        room.cube(0)
