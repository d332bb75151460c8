"""Range, velocity and angle come back through every way in which a radar may use its transmitters."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import ANTENNAS, halfwave_positions, ti_board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.transmit_code import tx_code_of
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.points import point_cloud

CHIRP = {
    "chirp_slope_hz_per_s": 60.012e12, "idle_time_s": 7e-6, "adc_start_time_s": 6e-6, "ramp_end_time_s": 65e-6,
    "num_samples": 64, "sample_rate_hz": 1.13e6, "num_loops": 32, "num_range_bins": 64,
}  # fmt: skip
TDM = ti_board("three", ANTENNAS["boost"], tx_order=(0, 2, 1), **CHIRP)
FOUR = replace(
    TDM, tx_position_m=halfwave_positions(((0.0, 0.0), (2.0, 1.6), (4.0, 0.0), (8.0, 0.0)), 79e9), tx_order=(0, 2, 3, 1)
)
STEER = np.exp(2j * np.pi * np.array([[0.0, 0.30, 0.60]]))


def coded(weights: np.ndarray, config: RadarConfig = TDM) -> RadarConfig:
    return replace(config, tx_order=tuple(range(config.num_tx)), tx_code=tx_code_of(weights))


SCHEMES = {
    "TDM": TDM,
    "TDM of four transmitters": FOUR,
    "BPM of the azimuth pair, TDM of the elevated": coded(np.array([[1, 0, 1], [0, 1, 0], [1, 0, -1]])),
    "Hadamard over four": coded(
        np.array([[1, 1, 1, 1], [1, -1, 1, -1], [1, 1, -1, -1], [1, -1, -1, 1]]), FOUR
    ),
    "phases of thirds over three": coded(np.exp(2j * np.pi * np.outer(range(3), range(3)) / 3)),
    "four in six Doppler bands": coded(np.exp(2j * np.pi * np.outer(range(6), (0, 3, 1, 2)) / 6), FOUR),
    "bursts with a pause": replace(TDM, loop_gap_s=400e-6),
}  # fmt: skip
RANGE_M, SPEED_MPS, AZIMUTH_RAD, ELEVATION_RAD = 2.1, 0.8, 0.3, -0.12


def cube_of(config: RadarConfig, speed_mps: float = SPEED_MPS, at_rad: float = AZIMUTH_RAD, up_rad=ELEVATION_RAD):
    """The cube of one receding point, from the exact sum."""
    towards = np.array([np.sin(at_rad) * np.cos(up_rad), np.cos(at_rad) * np.cos(up_rad), np.sin(up_rad)])

    def position_m(time_s: np.ndarray) -> np.ndarray:
        return (RANGE_M + speed_mps * time_s)[None, :, None] * towards

    samples = exact_frame(position_m, np.ones(1, complex), config)[None]
    rng = np.random.default_rng(0)
    samples = samples + 1e-3 * (rng.standard_normal(samples.shape) + 1j * rng.standard_normal(samples.shape))
    return radar_cube(AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0))


@pytest.mark.parametrize("name", list(SCHEMES))
def test_a_moving_point_is_found_where_it_is(name: str):
    cube = cube_of(SCHEMES[name])
    cloud = point_cloud(cube)
    best = int(np.argmax(cloud.snr_db))
    range_m = np.sqrt(cloud.x_m[best] ** 2 + cloud.y_m[best] ** 2 + cloud.z_m[best] ** 2)
    assert range_m == pytest.approx(RANGE_M, abs=0.02)
    assert cloud.radial_velocity_mps[best] == pytest.approx(SPEED_MPS, abs=0.05)
    assert np.arctan2(cloud.x_m[best], cloud.y_m[best]) == pytest.approx(AZIMUTH_RAD, abs=np.radians(1.5))
    assert cloud.z_m[best] / range_m == pytest.approx(np.sin(ELEVATION_RAD), abs=0.03)
    peak = np.abs(cube.values).max()
    assert peak == pytest.approx(1.0, abs=0.3)  # a tone of amplitude a peaks at a, but for what lies between bins


@pytest.mark.parametrize("name", [name for name, config in SCHEMES.items() if config.is_coded])
def test_decoding_takes_the_transmitters_apart(name: str):
    """Antennas of a moving point differ by the phases of their positions alone."""
    cube = cube_of(SCHEMES[name], speed_mps=2 * TDM.velocity_resolution_mps * 3 / SCHEMES[name].num_slots)
    cell = np.unravel_index(np.abs(cube.values[0]).sum(axis=-1).argmax(), cube.values.shape[1:3])
    signal = cube.values[0][cell]
    level_db = 20 * np.log10(np.abs(signal))
    assert np.ptp(level_db) < 1.5


def test_a_steered_beam_is_strongest_where_it_points_and_receivers_find_the_angle():
    """Phases of 0.3 turns a transmitter, a wavelength apart: towards sin(azimuth) = 0.3. A row of four receivers."""
    flat = replace(TDM, tx_position_m=halfwave_positions(((0.0, 0.0), (2.0, 0.0), (4.0, 0.0)), 79e9))
    config = coded(STEER, flat)
    assert config.num_antennas == 4
    towards, away = (np.abs(cube_of(config, at_rad=float(np.arcsin(x)), up_rad=0.0).values).max() for x in (0.3, 0.0))
    assert towards == pytest.approx(3.0, rel=0.3)
    assert away < 0.6 * towards
    cloud = point_cloud(cube_of(config, at_rad=float(np.arcsin(0.3)), up_rad=0.0))
    best = int(np.argmax(cloud.snr_db))
    assert cloud.x_m[best] / RANGE_M == pytest.approx(0.3, abs=0.05)
