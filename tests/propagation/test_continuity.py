"""Nothing jumps in time: spectrograms of frames without pauses, and shadows of people on the room."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver import Weaver
from mmweaver.core.boards import AWR1843
from mmweaver.propagation.occlusion import people_shadow, shadow
from mmweaver.propagation.paths import ApparentPoint, FrameClock, Interaction, Paths
from mmweaver.propagation.static_paths import scattered_paths
from tests.rooms import standing_person

# one transmitter, 128 chirps of 0.2 ms, frames of 25.6 ms back to back
BACK_TO_BACK = replace(
    AWR1843, name="back to back", tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,), num_loops=128,
    idle_time_s=135e-6, frame_period_s=25.6e-3, num_range_bins=128, first_range_bin=0,
)  # fmt: skip
WINDOW, HOP = 128, 32


@pytest.mark.parametrize("method", ["physics", "weaver"])
def test_no_column_of_a_spectrogram_stands_out_beyond_the_body(method: str):
    """Power beyond 3.5 m/s over that of quiet columns; stripes of 13 to 15 dB before, in a third of the columns."""
    weaver = Weaver(method=method, radar=BACK_TO_BACK)
    made = weaver.generate(
        weaver.sample_room(), "a person walks towards the radar", frames=24, seed=1, keep_adc=True, board="ideal"
    )
    samples = made.adc.samples[:, :, 0, 0].reshape(-1, 256)
    bins = np.fft.fft(samples * np.sin(np.pi * np.arange(256) / 256) ** 2, axis=-1)[:, 5:90]
    starts = range(0, len(bins) - WINDOW, HOP)
    pieces = np.stack([bins[at : at + WINDOW] - bins[at : at + WINDOW].mean(axis=0) for at in starts])
    spectra = np.fft.fft(pieces * np.hanning(WINDOW)[:, None], axis=1)
    velocity = np.fft.fftfreq(WINDOW, BACK_TO_BACK.loop_period_s) * BACK_TO_BACK.wavelength_m / 2
    power = (np.abs(spectra[:, np.abs(velocity) > 3.5]) ** 2).mean(axis=(1, 2))
    over_db = 10 * np.log10(power / np.percentile(power, 10))
    assert np.mean(over_db < 1.5) > 0.97
    assert over_db.max() < 3.0


def test_weights_of_chirps_add_up_over_frames_without_pauses():
    clock = FrameClock(BACK_TO_BACK)
    assert clock.is_continuous
    assert not FrameClock(AWR1843).is_continuous
    total = np.zeros_like(clock.chirp_s)
    for one in clock.faded_segments:
        total[one.segment.loops] += one.share
    assert total == pytest.approx(np.ones_like(total))
    assert {one.frame for one in clock.faded_segments} == {-1, 0, 1}


def test_the_frame_before_the_first_is_carried_back():
    motion = np.zeros((2, 1, 3, 3))
    motion[:, 0, 0] = [[0.0, 2.0, 0.0], [0.0, 1.9, 0.0]]
    motion[:, 0, 1] = [0.0, -1.0, 0.0]
    paths = Paths.of(np.ones(1), motion, motion, Interaction.BODY)
    before = paths.of_segment(0, 1, -1, -0.1)
    assert before.departure.position_m[:, 0, 1].tolist() == pytest.approx([2.1, 2.0])
    after = paths.of_segment(0, 1, 1, 0.1)
    assert after.arrival.position_m[:, 0, 1].tolist() == pytest.approx([1.9, 1.8])


def test_a_shadow_is_half_the_field_at_the_edge_and_fades_over_a_fresnel_zone():
    """A body 2 m away in front of places 4 m away: Fresnel zone of 6 cm; a knife edge takes 6 dB on the edge."""
    joints = torch.from_numpy(standing_person((0.0, 2.0, -1.2)).joints_m[:1]).float()
    x_m = torch.linspace(-1.2, 1.2, 481)
    ends_m = torch.stack([2 * x_m, torch.full_like(x_m, 4.0), torch.full_like(x_m, 0.0)], dim=1)
    wave, rays = (shadow(ends_m, joints, wavelength_m)[0] for wavelength_m in (3.8e-3, 1e-9))
    assert float(rays.max()) == pytest.approx(1, abs=1e-3)
    assert 0.75 < float(wave.max()) < 1
    edge = int((rays > 0.5).nonzero()[0, 0])
    assert float(wave[edge]) == pytest.approx(0.42, abs=0.12)  # the edge of an arm, whose other edge is near
    assert float(wave.diff().abs().max()) < 0.065  # per 5 mm
    assert float(wave[x_m.abs() > 0.9].max()) == 0


def test_a_wall_line_fades_as_a_person_walks_through_it():
    """From frame to frame of 50 ms at 1 m/s less than 6 dB out and back; all or nothing jumped by up to 23 dB."""
    joints = torch.from_numpy(standing_person((-1.0, 2.0, -1.2), (1.0, 0.0, 0.0)).joints_m[::6]).float()
    paths = scattered_paths(np.array([[0.0, 4.0, 0.0]]), np.ones(1), Interaction.DIFFUSE, AWR1843)
    left = 1 - people_shadow(paths, [joints], AWR1843.wavelength_m)[:, 0]
    assert float(left[0]) == float(left[-1]) == 1
    assert float(left.min()) < 0.1
    steps_db = 20 * torch.log10(left).diff().abs()
    assert float(steps_db.max()) < 14
    assert ApparentPoint.of(np.zeros((1, 3, 3))).later(1.0).position_m.shape == (1, 3)
