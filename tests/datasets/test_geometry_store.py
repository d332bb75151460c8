"""A data set without signals: synthesised ones equal stored ones, and no ray is cast."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset
from mmweaver.datasets.geometry_store import StoredGeometry
from mmweaver.datasets.room_generation import generate_room
from mmweaver.propagation.static_paths import FIRST_ORDER
from tests.training.tiny_data import TINY_PLAN

pytest.importorskip("zarr")


@pytest.fixture(scope="module")
def folders(tiny_geometry: Path, tiny_signals: Path) -> dict[bool, Path]:
    return {True: tiny_geometry, False: tiny_signals}


def _error(got: np.ndarray, wanted: np.ndarray) -> float:
    return float((np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum())


def test_synthesised_signals_equal_simulated_ones_of_first_order(folders: dict[bool, Path]):
    """-35 dB was measured: occlusion of static paths changes within a frame in the simulator alone."""
    frames, specs = TINY_PLAN.num_frames, sorted(TINY_PLAN.rooms(), key=lambda spec: spec.kind)
    for synthesised, spec in zip(read_rooms(folders[True]), specs, strict=True):
        simulated = generate_room(spec, AWR1843, frames, propagation=FIRST_ORDER)
        assert _error(synthesised.static, simulated.static) < 1e-6
        for index, one in enumerate(simulated.sequences):
            assert one.cube is not None
            assert np.array_equal(synthesised.joints_m[index], one.joints_m)
            got = synthesised.cube(index).values
            assert _error(got, one.cube.values) < 1e-3
            assert _error(synthesised.cube(index, np.array([1, 3])).values, got[[1, 3]]) < 1e-3


def test_stored_signals_have_more_paths(folders: dict[bool, Path]):
    """The same people in the same rooms, with second order and clutter."""
    for synthesised, stored in zip(read_rooms(folders[True]), read_rooms(folders[False]), strict=True):
        assert np.array_equal(synthesised.joints_m, stored.joints_m)
        assert synthesised.split == stored.split
        assert _error(synthesised.static, stored.static) > 1e-3
        wanted = stored.cube(0).values
        assert _error(synthesised.cube(0).values - synthesised.static[:, None], wanted - stored.static[:, None]) > 1e-3
        assert np.array_equal(stored.cube(0, np.array([1, 3])).values, wanted[[1, 3]])


def test_another_realization_is_another_signal(folders: dict[bool, Path]):
    room = read_rooms(folders[True])[0]
    first, other = room.cube(0).values, room.cube(0, realization=7).values
    assert _error(other, first) > 0.3
    assert np.array_equal(other, room.cube(0, realization=7).values)


def test_geometry_of_another_body_surface_is_refused(folders: dict[bool, Path], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("mmweaver.datasets.geometry_store.skin_mark", lambda: "another")
    with pytest.raises(InputError, match="another version"):
        read_rooms(folders[True])[0].cube(0)


def test_geometry_at_other_instants_of_the_frame_is_refused(folders: dict[bool, Path]):
    """Longer chirps cut a frame into more segments: what is stored for another count of nodes cannot be used."""
    stored = read_rooms(folders[True])[0].geometry
    assert stored is not None
    longer = replace(AWR1843, num_loops=4 * AWR1843.num_loops)
    with pytest.raises(InputError, match="instants a frame"):
        _ = StoredGeometry(files=stored.files, config=longer).node_joints_m


def test_signals_and_geometry_are_not_mixed(folders: dict[bool, Path]):
    with pytest.raises(InputError, match="another plan"):
        generate_dataset(folders[True], replace(TINY_PLAN, geometry_only=False), AWR1843)
