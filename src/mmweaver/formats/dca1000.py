"""The DCA1000's adc_data.bin: little-endian int16, complex samples in groups of two, no header.

Order: frame, loop, transmitter (in firing order), receiver, sample. Each four words hold two consecutive samples of
one receiver: I0 I1 Q0 Q1 ("iq", mmWave Studio's default) or Q0 Q1 I0 I1 ("qi", the SDK's demo, SampleSwap 1). The
wrong order reverses the range axis.

Reference: TI SWRA581B, mmWave Radar Device ADC Raw Data Capture.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube

IQ_ORDERS = ("iq", "qi")
INT16_MAX = 32767
WORDS_PER_SAMPLE = 2
HEADROOM = 0.5  # share of full scale of the largest word where `write_bin` chooses the scale


def read_bin(
    path: Path | str, config: RadarConfig, *, iq_order: str = "iq", tx_order: tuple[int, ...] | None = None
) -> AdcCube:
    """Reads a recording; samples are in counts of the converter, so their scale is unknown (nan).

    `tx_order` is the firing order of the recording where it differs from the configuration's; the returned
    configuration then has it, because the TDM timing depends on it. Raises InputError where the file cannot be read,
    is empty or ends within a frame, or where the radar's samples are real or odd in number.
    """
    config = _checked(config, iq_order, tx_order)
    path = Path(path)
    if path.is_dir():
        raise InputError(f"cannot read {path}: it is a folder; give the adc_data.bin in it")
    try:
        size = path.stat().st_size
        num_frames = _num_frames(path, size, config)
        words = np.fromfile(path, dtype="<i2", count=num_frames * bytes_of_frame(config) // 2)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    return adc_of_words(words, config, iq_order=iq_order)


def bytes_of_frame(config: RadarConfig) -> int:
    """The bytes that a DCA1000 sends per radar frame."""
    return config.num_loops * config.num_antennas * config.num_samples * WORDS_PER_SAMPLE * 2


def adc_of_words(words: np.ndarray, config: RadarConfig, *, iq_order: str = "iq") -> AdcCube:
    """Decodes int16 words, (word,), of whole frames as a DCA1000 sends them; samples in counts.

    Raises InputError where the radar's samples are real or odd in number.
    """
    config = _checked(config, iq_order, None)
    num_frames = 2 * len(words) // bytes_of_frame(config)
    pairs = words.reshape(-1, 2, 2)  # (two samples, component, sample of the two)
    real, imaginary = (0, 1) if iq_order == "iq" else (1, 0)
    samples = np.empty((len(pairs), 2), np.complex64)
    samples.real, samples.imag = pairs[:, real], pairs[:, imaginary]
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    return AdcCube(samples=by_transmitter(samples.reshape(shape), config.tx_order), config=config, scale=float("nan"))


def write_bin(
    path: Path | str,
    adc: AdcCube,
    *,
    iq_order: str = "iq",
    tx_order: tuple[int, ...] | None = None,
    counts_per_unit: float | None = None,
) -> float:
    """Writes a file for `read_bin` and TI's own tools; returns the counts per unit of the samples.

    Without `counts_per_unit` the largest component is scaled to half of full scale. `tx_order` changes only the order
    in the file, for readers with a fixed order; the samples keep the timing of their own configuration. Raises
    InputError where a sample is not finite or does not fit int16, where samples are real or odd in number, or where
    the file cannot be written.
    """
    config = _checked(adc.config, iq_order, tx_order)
    samples = adc.samples[:, :, list(config.tx_order)]
    parts = np.real(samples), np.imag(samples)
    low = float(min(part.min(initial=0) for part in parts))
    high = float(max(part.max(initial=0) for part in parts))
    peak = max(-low, high)
    if not np.isfinite(peak):
        raise InputError("the ADC samples hold values that are not finite; nothing was written")
    if counts_per_unit is None:
        counts_per_unit = HEADROOM * INT16_MAX / peak if peak > 0 else 1.0
    if not (np.isfinite(counts_per_unit) and counts_per_unit > 0):
        raise InputError(f"counts per unit must be above 0 and finite, not {counts_per_unit}")
    # int16 has one more negative count: a converter that clips writes -32768
    if round(high * counts_per_unit) > INT16_MAX or round(low * counts_per_unit) < -INT16_MAX - 1:
        raise InputError(
            f"a sample of {peak * counts_per_unit:.0f} counts does not fit int16;"
            f" take at most {INT16_MAX / peak:.6g} counts per unit"
        )
    grouped = samples.reshape(-1, 2)
    pairs = np.empty((len(grouped), 2, 2), "<i2")
    real, imaginary = (0, 1) if iq_order == "iq" else (1, 0)
    pairs[:, real] = np.rint(np.real(grouped) * np.float64(counts_per_unit))
    pairs[:, imaginary] = np.rint(np.imag(grouped) * np.float64(counts_per_unit))
    with atomic_file(Path(path)) as temporary:
        pairs.tofile(temporary)
    return float(counts_per_unit)


def by_transmitter(samples: np.ndarray, tx_order: Sequence[int]) -> np.ndarray:
    """Reorders (frame, loop, slot, rx, sample), transmitters in firing order, to (frame, loop, tx, rx, sample)."""
    return samples[:, :, np.argsort(tx_order)]


def _checked(config: RadarConfig, iq_order: str, tx_order: tuple[int, ...] | None) -> RadarConfig:
    if iq_order not in IQ_ORDERS:
        raise InputError(f"unknown I/Q order {iq_order!r}; known: {', '.join(IQ_ORDERS)}")
    if not config.complex_samples:
        raise InputError(f"radar {config.name!r} has real samples, a DCA1000 file holds complex ones; use .npy")
    if config.num_samples % 2:
        raise InputError(
            f"a DCA1000 file holds samples in pairs, but a chirp has {config.num_samples}; take an even number"
        )
    return config if tx_order is None else replace(config, tx_order=tuple(tx_order))


def _num_frames(path: Path, size: int, config: RadarConfig) -> int:
    frame_bytes = bytes_of_frame(config)
    layout = f"{config.num_loops} loops x {config.num_tx} TX x {config.num_rx} RX x {config.num_samples} samples x 4"
    if size == 0:
        raise InputError(f"{path} is empty")
    if size % frame_bytes:
        raise InputError(
            f"{path} has {size} bytes: {size // frame_bytes} whole frames of {frame_bytes} bytes ({layout}) and"
            f" {size % frame_bytes} bytes more; the file is truncated or --radar is not the radar that recorded it"
        )
    return size // frame_bytes
