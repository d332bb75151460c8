"""Patches of target signal: the cube's own values, the same from the same step, shared among processes."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.models.hypernetwork import unit_sqrt_mw
from mmweaver.training.signal_examples import SignalRoomExamples, sample_signal_batch, signal_rooms

pytest.importorskip("zarr")


@pytest.fixture(scope="module", params=["tiny_signals", "tiny_geometry"])
def room(request: pytest.FixtureRequest) -> SignalRoomExamples:
    folder: Path = request.getfixturevalue(request.param)
    (room,) = signal_rooms(folder, "train")
    return room


def test_patches_hold_what_the_cube_holds_at_those_coordinates(room: SignalRoomExamples):
    batch = sample_signal_batch([room], 0, 0, size=1)
    assert batch.truth[0].shape == (2, 21, 32, 12)
    assert batch.points[0].shape == (21 * 32 * 12, 3)
    r, d, a = batch.points[0].T
    cell = torch.stack([(r + 1) / 2 * 63, (d + 1) / 2 * 31, (a + 1) / 2 * 11]).round().long()
    cubes = [room.room.cube(index).values for index in room.indices]
    there = [cube[int(batch.frames[0, 0])][tuple(cell.numpy())] / unit_sqrt_mw(AWR1843) for cube in cubes]
    least = 1e-3 * float(batch.truth.abs().max())
    assert any(np.allclose(one, batch.truth[0, 0].flatten(), rtol=1e-3, atol=least) for one in there)


def test_processes_share_a_batch(room: SignalRoomExamples):
    whole = sample_signal_batch([room], 0, 3, size=4)
    for rank in (0, 1):
        part = sample_signal_batch([room], 0, 3, size=4, share=(rank, 2))
        assert torch.equal(part.truth, whole.truth[rank::2])
        assert torch.equal(part.motion, whole.motion[rank::2])
    assert not torch.equal(whole.truth, sample_signal_batch([room], 0, 4, size=4).truth)
