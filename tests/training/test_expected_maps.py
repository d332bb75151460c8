"""Expected maps against the mean over many realizations of the same geometry."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.datasets.dataset_store import StoredRoom, read_rooms
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.training.network_examples import ExpectedMaps, examples, power_maps

pytest.importorskip("zarr")
REALIZATIONS = 16
FRAMES = np.array([0, 2])
NAMES = ("range_doppler", "range_azimuth", "range_elevation")


@pytest.fixture(scope="module")
def room(tiny_geometry: Path) -> StoredRoom:
    return read_rooms(tiny_geometry)[0]


@pytest.fixture(scope="module")
def sampled_mean(room: StoredRoom) -> PowerMaps:
    sampled = [
        power_maps(room.cube(0, FRAMES, realization=1 + realization).values, room.config)
        for realization in range(REALIZATIONS)
    ]
    return PowerMaps(**{name: torch.stack([vars(maps)[name] for maps in sampled]).mean(dim=0) for name in NAMES})


def test_moving_cells_are_the_mean_over_realizations(room: StoredRoom, sampled_mean: PowerMaps):
    """0.1 to 0.4 dB with 16 realizations, whose mean fluctuates itself.

    In cells more than 40 dB below the strongest the expected map of a fast walk is up to 0.6 dB too low on average.
    """
    expected = ExpectedMaps(room).frames(0, FRAMES)[0].range_doppler
    sampled = sampled_mean.range_doppler
    shown = sampled > sampled.max() * 1e-4
    middle = shown.shape[-1] // 2
    shown[..., middle - 1 : middle + 2] = False
    gap_db = 10 * torch.log10(expected / sampled)[shown]
    assert shown.sum() > 20
    assert gap_db.mean().abs() < 0.5
    assert gap_db.abs().mean() < 1.3  # 0.9 with 64 realizations


def test_the_person_alone_is_the_difference_from_the_room(room: StoredRoom):
    whole, alone = ExpectedMaps(room).frames(0, FRAMES)
    middle = alone.range_doppler.shape[-1] // 2
    moving = [column for column in range(2 * middle) if abs(column - middle) > 3]
    noise = ExpectedMaps(room).radar.noise_maps()[0]
    gap = whole.range_doppler[..., moving] - noise - alone.range_doppler[..., moving]
    assert gap.abs().max() < 0.02 * alone.range_doppler.max()


def test_all_power_is_there(room: StoredRoom, sampled_mean: PowerMaps):
    expected = ExpectedMaps(room).frames(0, FRAMES)[0]
    for name in NAMES:
        gap_db = 10 * torch.log10(getattr(expected, name).sum() / getattr(sampled_mean, name).sum())
        assert gap_db == pytest.approx(0, abs=1.0), name


def test_training_uses_expected_maps(tiny_geometry: Path):
    one = examples(tiny_geometry, "train")[0]
    expected = ExpectedMaps(one.room)
    assert torch.equal(one.static.range_azimuth, expected.static.range_azimuth)
    index = one.indices[0]
    assert torch.equal(one.maps(index, FRAMES)[0].range_doppler, expected.frames(index, FRAMES)[0].range_doppler)
