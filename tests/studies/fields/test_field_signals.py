from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.propagation.paths import Interaction
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from studies.fields.field_signals import SIGNALS, sample_scene, simulated, simulator_of, without_room
from studies.scores.cube_scores import cells_of
from studies.scores.scorecard import scorecard


def test_the_walking_person_moves_and_the_twin_is_a_twin():
    signal = simulated("walking", is_alone=True, num_frames=4)
    assert signal.cube.grid.shape == (4, 64, 32, 12)
    power = range_doppler_power(signal.cube)
    assert power[cells_of(signal.cube).is_moving].sum() > 0.5 * power.sum()
    assert signal.realization is not None
    scores = scorecard(signal.realization, signal.cube)
    assert scores.prediction["nmse_db"] > 0  # another phase: worse than zeros
    assert scores.prediction["rd_ssim"] > scores.baselines["static_mean"]["rd_ssim"]
    assert signal.noise_free is not None
    assert scorecard(signal.noise_free, signal.cube).prediction["nmse_active_db"] < -30
    again = simulated("walking", is_alone=True, num_frames=4)
    assert again.digest == signal.digest
    assert replace(signal, cube=signal.realization).digest != signal.digest


def test_without_room_nothing_stands_still():
    assert len(without_room(sample_scene()).faces) == 0
    alone = simulated("walking", is_alone=True, num_frames=2)
    room = simulated("walking", is_alone=False, num_frames=2)
    assert cells_of(room.cube).is_active.mean() > cells_of(alone.cube).is_active.mean()


def test_walkers_have_all_paths_and_the_clutter_of_their_room():
    for scene, has_clutter in ((sample_scene(), True), (without_room(sample_scene()), False)):
        room = simulator_of(scene, AWR1843).room
        assert room.propagation.bounces == 2
        assert bool((room.paths.interaction == int(Interaction.CLUTTER)).any()) is has_clutter


def test_recordings_need_their_folder():
    with pytest.raises(InputError, match="--data"):
        SIGNALS["two_people"](None)
    with pytest.raises(InputError, match="unknown signal"):
        SIGNALS["dancing"](None)
    with pytest.raises(InputError, match="--data"):
        SIGNALS["walking_in_recording"](None)


def test_the_real_two_people_are_as_measured(real_data):
    """All zeros score 29.7 dB and 0.92; 11 % of the cells are active and half of the energy moves."""
    signal = SIGNALS["two_people"](real_data)
    cube, cells = signal.cube, cells_of(signal.cube)
    power = range_doppler_power(cube)
    assert cells.is_active.mean() == pytest.approx(0.109, abs=0.005)
    assert power[cells.is_moving].sum() / power.sum() == pytest.approx(0.52, abs=0.01)
    card = scorecard(cube, cube)
    assert card.baselines["zeros"]["psnr_db"] == pytest.approx(29.8, abs=0.2)
    assert card.baselines["zeros"]["cssim"] == pytest.approx(0.922, abs=0.005)
    assert card.baselines["static_mean"]["cssim"] == pytest.approx(0.962, abs=0.005)
    assert card.baselines["static_mean"]["nmse_db"] == pytest.approx(-1.4, abs=0.1)


def test_the_breathing_person_is_read(real_data):
    cube = SIGNALS["breathing"](real_data).cube
    assert cube.grid.shape == (20, 32, 8, 3)
    assert np.isfinite(cube.values).all()


def test_a_walker_in_a_recording_has_its_clutter_its_noise_and_the_peoples_strength(real_data):
    signal, people = SIGNALS["walking_in_recording"](real_data), SIGNALS["two_people"](real_data)
    assert signal.cube.grid.shape == people.cube.grid.shape
    powers = [range_doppler_power(one.cube) for one in (signal, people)]
    fast = [power[:, :, moving_doppler(people.cube)].max() for power in powers]
    floor = [np.median(power[:, :, :4]) for power in powers]
    assert 10 * np.log10(fast[0] / fast[1]) == pytest.approx(0.0, abs=0.3)
    assert 10 * np.log10(floor[0] / floor[1]) == pytest.approx(0.0, abs=1.5)
    still = [cube.values[:, 40:, 16].mean(axis=0).ravel() for cube in (signal.cube, people.cube)]  # behind the people
    likeness = abs(np.vdot(still[0], still[1])) / np.linalg.norm(still[0]) / np.linalg.norm(still[1])
    assert likeness > 0.9
    assert signal.realization is not None
    assert scorecard(signal.realization, signal.cube).prediction["nmse_moving_db"] > 0.5
