import numpy as np
import pytest
from studies.fields.unusual_signals import (
    CLIPPED_SHARE,
    UNUSUAL,
    cascade,
    decimated,
    moving_radar,
    noise_alone,
    saturated,
    with_bursts,
)

from mmweaver.core.errors import InputError
from studies.scores.cube_scores import cells_of


def test_recordings_are_changed_as_their_names_say():
    adc = noise_alone(2)
    largest = float(np.abs(adc.samples.view(np.float32)).max())
    cut_off = saturated(adc).samples
    assert np.abs(cut_off.view(np.float32)).max() == pytest.approx(CLIPPED_SHARE * largest, rel=1e-5)
    is_hit = (with_bursts(adc).samples != adc.samples).any(axis=(2, 3, 4))
    assert 0 < is_hit.mean() < 0.2
    assert decimated(adc).samples.shape[1:] == (16, 3, 4, 128)
    assert cascade().num_antennas == 192


def test_reflectors_approach_a_moving_radar():
    cube = moving_radar(2)
    power = np.where(cells_of(cube).is_active, np.square(np.abs(cube.values)).sum(axis=3), 0).sum(axis=(0, 1))
    mean_mps = (power * cube.grid.radial_velocity_mps).sum() / power.sum()
    assert -1.2 < mean_mps < -0.5


def test_some_are_made_of_recordings():
    with pytest.raises(InputError, match="--data"):
        UNUSUAL[next(iter(UNUSUAL))](None)
