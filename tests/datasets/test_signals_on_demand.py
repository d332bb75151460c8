"""A set without stored signals makes the same ones when asked: in any order, in workers, by either method."""

import pickle
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from torch.utils.data import DataLoader

from mmweaver.core.errors import InputError
from mmweaver.datasets import RadarDataset, collate
from mmweaver.datasets.activity_store import ActivitySet, read_activity_set
from mmweaver.datasets.build_set import SetBuilder, read_activities
from mmweaver.datasets.signals_on_demand import moving_power_db
from mmweaver.models.methods import Physics
from mmweaver.propagation.static_paths import Propagation
from mmweaver.weaver.front_door import Weaver
from tests.datasets.conftest import ACTIVITIES, OPTIONS, builder

pytest.importorskip("zarr")
FEW = replace(OPTIONS, each=1, seconds=0.6)


def made(folder: Path, kind: str, **changes: object) -> ActivitySet:
    folder.mkdir(parents=True)
    builder(folder / "set", replace(FEW, iq=kind, **changes)).make()
    return read_activity_set(folder / "set")


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[ActivitySet, ActivitySet]:
    """The same set without and with signals."""
    folder = tmp_path_factory.mktemp("sets")
    return made(folder / "none", "none"), made(folder / "float32", "float32")


def size(stored: ActivitySet) -> int:
    return sum(file.stat().st_size for file in stored.files.folder.rglob("*") if file.is_file())


def test_signals_are_those_that_would_have_been_stored(both: tuple[ActivitySet, ActivitySet]):
    on_demand, stored = both
    for index in reversed(range(len(stored))):
        np.testing.assert_allclose(on_demand.cube(index).values, stored.cube(index).values, rtol=0, atol=1e-12)
        assert on_demand.cube(index).scale == stored.cube(index).scale
    for name in ("points", "joints_m", "point_sequence"):
        np.testing.assert_array_equal(getattr(on_demand, name), getattr(stored, name))
    assert on_demand.arrays.path.name == "sequences.zarr"
    assert "iq" not in on_demand.arrays
    assert size(on_demand) < size(stored) / 2  # of six frames; the photo is the larger part


def test_workers_and_copies_make_the_same(both: tuple[ActivitySet, ActivitySet]):
    data = RadarDataset(both[0], ("iq", "micro_doppler", "label"))
    alone = next(iter(DataLoader(data, batch_size=3, collate_fn=collate)))
    shared = next(iter(DataLoader(data, batch_size=3, collate_fn=collate, num_workers=1)))
    copy = pickle.loads(pickle.dumps(data))[2]["iq"]  # noqa: S301  as processes that are not forked get it
    for name in alone:
        torch.testing.assert_close(shared[name], alone[name], rtol=1e-5, atol=1e-9)
    torch.testing.assert_close(copy, alone["iq"][2], rtol=1e-5, atol=1e-9)


def test_another_version_of_the_signal_is_noticed(both: tuple[ActivitySet, ActivitySet], tmp_path: Path):
    stored = read_activity_set(both[0].files.folder)
    assert stored.on_demand is not None
    stored.on_demand._power_db = stored.on_demand._power_db + 1.0
    with pytest.raises(InputError, match="sequence 0"):
        stored.cube(0)
    stored.on_demand.method = "gone"
    stored.on_demand._rooms.clear()
    with pytest.raises(InputError, match="not installed"):
        stored.cube(0)


def test_what_cannot_be_made_again_is_refused(tmp_path: Path):
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    plain, first_order = Weaver(), Weaver(Physics(Propagation(bounces=1)))
    room = plain.sample_room()
    with_background = room.with_background(
        plain.generate(room, "a person stands", frames=2).cube  # any cube of this radar
    )
    for weaver, where, said in ((first_order, room, "propagation"), (plain, with_background, "background")):
        with pytest.raises(InputError, match=said):
            SetBuilder(
                tmp_path / "set", read_activities(tmp_path / "a.toml"), [where], weaver, replace(FEW, iq="none"),
                command="", activities_text=ACTIVITIES,
            )  # fmt: skip


@pytest.mark.parametrize("victim", ["seed/c/0", "motion_m/c/0/0/0/0", "room_0/photo_rgb/c/0/0/0", "zarr.json"])
@pytest.mark.parametrize("how", ["deleted", "flipped"])
def test_damage_of_what_signals_are_made_from_is_refused(
    both: tuple[ActivitySet, ActivitySet], tmp_path: Path, victim: str, how: str
):
    shutil.copytree(both[0].files.folder, tmp_path / "set")
    file = tmp_path / "set" / "sequences.zarr" / "geometry" / victim
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 4
    file.write_bytes(data)
    if how == "deleted":
        file.unlink()
    with pytest.raises(InputError):
        read_activity_set(tmp_path / "set").cube(0)


def test_moving_power_leaves_out_what_stands_still(both: tuple[ActivitySet, ActivitySet]):
    cube = both[1].cube(0)
    to_and_fro = np.where(np.arange(len(cube.values)) % 2, 3e-6, 1e-6)[:, None, None, None]  # sqrt(mW) about their mean
    known = replace(cube, values=np.broadcast_to(to_and_fro, cube.values.shape).astype(np.complex64) / cube.scale)
    assert len(cube.values) % 2 == 0
    assert moving_power_db(known) == pytest.approx(-120.0, abs=1e-3)
    still = replace(cube, values=cube.values + cube.values.mean())
    assert moving_power_db(still) == pytest.approx(moving_power_db(cube), abs=1e-3)
    assert moving_power_db(replace(cube, values=10 * cube.values)) == pytest.approx(
        moving_power_db(cube) + 20, abs=1e-3
    )
