"""Lost chirps add no echoes and move none: the points of a damaged recording are those of the whole one."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.lost_chirps import frames_left_out, without_lost_chirps
from mmweaver.signal.points import point_cloud
from tests.physics.test_point_target import exact_adc

RADAR = replace(AWR1843, num_loops=32)
FRAMES = 6


def recording() -> AdcCube:
    """A still echo and a moving one, straight ahead, and noise that differs between frames."""
    rng = np.random.default_rng(5)
    still = exact_adc(RADAR, np.array([0.0, 1.5, 0.0]), np.zeros(3)).samples
    frames = []
    for frame in range(FRAMES):
        place = np.array([0.0, 2.2 + 0.9 * RADAR.frame_period_s * frame, 0.0])
        moving = exact_adc(RADAR, place, np.array([0.0, 0.9, 0.0])).samples
        noise = rng.standard_normal((2, *still.shape[1:]))
        frames.append(100 * still[0] + 30 * moving[0] + 15 * (noise[0] + 1j * noise[1]))
    return AdcCube(samples=np.array(frames, np.complex64), config=RADAR, scale=1.0)


def azimuth_deg(adc: AdcCube) -> np.ndarray:
    """Of points clearly above the threshold of a single false alarm."""
    points = point_cloud(radar_cube(adc))
    return np.degrees(np.arctan2(points.x_m, points.y_m))[points.snr_db > 8]


@pytest.mark.parametrize("share", [0.08, 0.15])
def test_no_point_is_added_beside_the_echoes(share: float):
    adc = recording()
    is_lost = np.random.default_rng(2).random((FRAMES, RADAR.num_loops, RADAR.num_slots)) < share
    zeros = replace(adc, samples=np.where(is_lost[..., None, None], 0, adc.samples))
    whole, damaged, completed = (azimuth_deg(one) for one in (adc, zeros, without_lost_chirps(zeros, is_lost)))
    assert (np.abs(whole) < 5).all()
    assert (np.abs(damaged) > 10).sum() > 10  # what zeros would do
    assert (np.abs(completed) < 5).all()
    assert abs(len(completed) - len(whole)) <= 0.1 * len(whole)


def test_amplitudes_of_the_cells_are_those_of_whole_frames():
    adc = recording()
    is_lost = np.random.default_rng(3).random((FRAMES, RADAR.num_loops, RADAR.num_slots)) < 0.1
    zeros = replace(adc, samples=np.where(is_lost[..., None, None], 0, adc.samples))
    whole, completed = (np.abs(radar_cube(one).values) for one in (adc, without_lost_chirps(zeros, is_lost)))
    strong = whole > 0.3 * whole.max()
    ratio_db = 20 * np.log10(completed[strong] / whole[strong])
    assert np.abs(ratio_db).max() < 0.2


def test_a_frame_with_too_little_left_is_left_out():
    adc = recording()
    is_lost = np.zeros((FRAMES, RADAR.num_loops, RADAR.num_slots), bool)
    is_lost[2, : RADAR.num_loops // 2 + 1, 1] = True
    assert frames_left_out(is_lost).tolist() == [False, False, True, False, False, False]
    completed = without_lost_chirps(adc, is_lost)
    assert not completed.samples[2].any()
    others = [0, 1, 3, 4, 5]
    assert np.array_equal(completed.samples[others], adc.samples[others])
