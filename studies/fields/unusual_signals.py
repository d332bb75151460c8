"""Cubes unlike any that the codec was developed with: other radars, faulty recordings, a moving radar, noise alone."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843, PRESETS, halfwave_positions
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.registry import Registry
from mmweaver.core.seeding import stream
from mmweaver.dsp.cube import radar_cube
from mmweaver.paths.receiver import Impairments
from studies.fields.field_signals import StudySignal, pose_of, sample_scene, simulator_of
from studies.fields.recording_cuts import cut, office, person_breathing, two_people

BURST_SHARE, BURST_LEVEL = 0.04, 20.0  # of the chirps; amplitude over the root mean square of the samples
CLIPPED_SHARE = 0.3  # of the largest sample, at which a converter saturates
OFFSET_LEVEL = 10.0  # over the root mean square of the samples
CLUTTER_LEVEL = 300.0  # amplitude over that of the recording
RADAR_SPEED_MPS, NUM_REFLECTORS = 1.2, 300


@lru_cache(maxsize=1)
def walker(radar: RadarConfig, num_frames: int) -> AdcCube:
    """A person who walks in the sample room, before any radar."""
    pose = pose_of("walking", seconds=num_frames * radar.frame_period_s, radar=radar)
    return simulator_of(sample_scene(), radar, Impairments()).run(pose, num_frames=num_frames, seed=0).adc


def cascade() -> RadarConfig:
    """A cascade of 12 x 16 antennas in a row, 8 loops."""
    tx = tuple((16.0 * place, 0.0) for place in range(12))
    rx = tuple((float(place), 0.0) for place in range(16))
    return replace(
        AWR1843, name="cascade", tx_position_m=halfwave_positions(tx, 79e9), rx_position_m=halfwave_positions(rx, 79e9),
        tx_order=tuple(range(12)), rx_inverted=(), num_loops=8, num_range_bins=32,
    )  # fmt: skip


def changed(adc: AdcCube, samples: np.ndarray) -> AdcCube:
    return replace(adc, samples=samples.astype(np.complex64))


def level_of(adc: AdcCube) -> float:
    """Root mean square of the samples."""
    return float(np.sqrt(np.mean(np.square(np.abs(adc.samples), dtype=np.float64))))


def with_bursts(adc: AdcCube) -> AdcCube:
    """Another radar's chirps cross some of ours: short bursts on all antennas."""
    draw, samples = stream(0, "bursts"), adc.samples.copy()
    chirps = samples.reshape(-1, *samples.shape[-2:])  # (chirp, antenna, sample)
    for index in np.flatnonzero(draw.random(len(chirps)) < BURST_SHARE):
        first, length = draw.integers(0, chirps.shape[2] - 16), 16
        time = np.arange(length) - length / 2
        burst = BURST_LEVEL * level_of(adc) * np.exp(1j * (0.1 * time**2 + draw.uniform(0, 6)))
        chirps[index, :, first : first + length] += burst
    return changed(adc, samples)


def with_offset(adc: AdcCube) -> AdcCube:
    """A constant in every sample."""
    return changed(adc, adc.samples + OFFSET_LEVEL * level_of(adc) * (1 + 0.5j))


def saturated(adc: AdcCube) -> AdcCube:
    """Samples cut off at a share of the largest."""
    most = CLIPPED_SHARE * float(np.abs(adc.samples.view(np.float32)).max())
    return changed(adc, np.clip(adc.samples.real, -most, most) + 1j * np.clip(adc.samples.imag, -most, most))


def with_clutter(adc: AdcCube) -> AdcCube:
    """A corner reflector beside the radar, far stronger than all else, with a little phase noise."""
    draw, shape = stream(0, "clutter"), adc.samples.shape
    tone = np.exp(2j * np.pi * 0.11 * np.arange(shape[-1]))
    jitter = 1 + 1e-4 * (draw.normal(size=shape[:2]) + 1j * draw.normal(size=shape[:2]))
    ones = (...,) + (None,) * (len(shape) - 2)
    return changed(adc, adc.samples + CLUTTER_LEVEL * level_of(adc) * jitter[ones] * tone)


def moving_radar(num_frames: int = 20) -> RadarCube:
    """A radar that drives past reflectors at rest: every cell moves, each direction with a velocity of its own."""
    config, draw = AWR1843, stream(0, "moving radar")
    place = np.stack([draw.uniform(-2.5, 2.5, NUM_REFLECTORS), draw.uniform(0.5, 4, NUM_REFLECTORS)])
    echo = draw.normal(size=NUM_REFLECTORS) + 1j * draw.normal(size=NUM_REFLECTORS)
    grid = CubeGrid.of(config, num_frames)
    values = np.zeros(grid.shape, complex)
    antenna_m = np.asarray(grid.antenna_position_m)
    for frame, time_s in enumerate(grid.frame_time_s):
        moved = place - np.array([0.0, RADAR_SPEED_MPS * time_s])[:, None]
        range_m = np.hypot(*moved)
        direction = moved / range_m
        range_bin = range_m / config.range_resolution_m - config.first_range_bin
        doppler_bin = -RADAR_SPEED_MPS * direction[1] / config.velocity_resolution_mps + config.num_loops / 2
        turns = (antenna_m[:, :1] * direction[0] + antenna_m[:, 1:2] * direction[1]) / config.wavelength_m
        lobes = [
            _lobe(np.arange(size)[:, None] - at)
            for size, at in zip(grid.shape[1:3], (range_bin, doppler_bin), strict=True)
        ]
        turning = np.exp(2j * np.pi * (turns - 2 * range_m / config.wavelength_m)) * echo / range_m**2
        values[frame] = np.einsum("rk,dk,ak->rda", *lobes, turning)
    noise = stream(0, "moving radar noise").normal(size=(2, *grid.shape)) * 1e-3 * np.abs(values).max()
    return RadarCube(
        values=(values + noise[0] + 1j * noise[1]).astype(np.complex64), grid=grid, config=config, scale=float("nan")
    )


def _lobe(offset: np.ndarray) -> np.ndarray:
    """Spectrum of a Hann window at offsets in bins, with the phase of one centred on its middle sample."""
    return (np.sinc(offset) + 0.5 * np.sinc(offset - 1) + 0.5 * np.sinc(offset + 1)) * np.exp(-1j * np.pi * offset)


def noise_alone(num_frames: int = 20) -> AdcCube:
    """What a receiver without antennas records."""
    config = AWR1843
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    draw = stream(0, "noise alone").standard_normal((*shape, 2), dtype=np.float32).view(np.complex64)[..., 0]
    return AdcCube(samples=draw, config=config, scale=float("nan"))


def decimated(adc: AdcCube) -> AdcCube:
    """Every second sample and every second loop."""
    config = adc.config
    other = replace(
        config, num_samples=config.num_samples // 2, sample_rate_hz=config.sample_rate_hz / 2,
        num_loops=config.num_loops // 2, frame_period_s=2 * config.frame_period_s,
        idle_time_s=2 * config.idle_time_s + config.ramp_end_time_s, first_range_bin=0, num_range_bins=48,
    )  # fmt: skip
    return AdcCube(samples=np.ascontiguousarray(adc.samples[:, ::2, ..., ::2]), config=other, scale=float("nan"))


def _simulated(radar: Callable[[], RadarConfig], num_frames: int) -> Callable[[Path], RadarCube]:
    return lambda _: radar_cube(walker(radar(), num_frames))


def _one_tx() -> RadarConfig:
    return replace(AWR1843, tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,))


def _few_antennas(data: Path) -> RadarCube:
    return radar_cube(cut(two_people(data), frames=8, loops=16, antennas=2))


_MAKERS: tuple[tuple[str, Callable[[Path], RadarCube]], ...] = (
    ("walker, iwr6843aop, 10 frames", _simulated(lambda: PRESETS["iwr6843aop"], 10)),
    ("walker, iwr1443_mars, 20 frames", _simulated(lambda: PRESETS["iwr1443_mars"], 20)),
    ("walker, 1 transmitter", _simulated(_one_tx, 20)),
    ("walker, 2 loops, 60 frames", _simulated(lambda: replace(AWR1843, num_loops=2), 60)),
    ("walker, 128 range bins", _simulated(lambda: replace(AWR1843, first_range_bin=0, num_range_bins=128), 10)),
    ("walker, cascade of 192 antennas, 4 frames", _simulated(cascade, 4)),
    ("walker with interference", lambda _: radar_cube(with_bursts(walker(AWR1843, 20)))),
    ("walker with an offset", lambda _: radar_cube(with_offset(walker(AWR1843, 20)))),
    ("walker, saturated", lambda _: radar_cube(saturated(walker(AWR1843, 20)))),
    ("walker beside strong clutter", lambda _: radar_cube(with_clutter(walker(AWR1843, 20)))),
    ("moving radar", lambda _: moving_radar()),
    ("noise alone", lambda _: radar_cube(noise_alone())),
    ("two people, decimated", lambda data: radar_cube(decimated(two_people(data)))),
    ("two people with interference", lambda data: radar_cube(with_bursts(two_people(data)))),
    ("two people, 8 frames of 16 loops, 2 antennas", _few_antennas),
    ("office, 8 frames of 10 loops", lambda data: radar_cube(cut(office(data), frames=8, loops=10))),
    ("office, saturated", lambda data: radar_cube(saturated(office(data)))),
    ("breathing, decimated", lambda data: radar_cube(cut(person_breathing(data), frames=64, loops=4))),
)  # fmt: skip


def _signal(name: str, make: Callable[[Path], RadarCube]) -> Callable[[Path | None], StudySignal]:
    def signal(data: Path | None) -> StudySignal:
        if data is None:
            raise InputError("this signal is made of recordings; say where these lie with --data")
        return StudySignal(name=name, origin="simulated or changed", cube=make(data), realization=None)

    return signal


UNUSUAL: Registry[Callable[[Path | None], StudySignal]] = Registry(
    "unusual signal", [(name, _signal(name, make)) for name, make in _MAKERS]
)
