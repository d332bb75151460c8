"""The DCA1000's adc_data.bin: little-endian int16, no header.

Two lanes (xWR16xx, 18xx, 68xx): frame, loop, transmitter (in firing order), receiver, sample; each four words hold two
consecutive samples of one receiver: I0 I1 Q0 Q1 ("iq", mmWave Studio's default) or Q0 Q1 I0 I1 ("qi", the SDK's demo,
SampleSwap 1), or, as other recorders store them, I0 Q0 I1 Q1 ("interleaved"). Four lanes (xWR12xx, 14xx): frame, loop,
transmitter, sample; each eight words hold one sample of receivers 0 to 3, first I of all, then Q ("qi": Q first);
disabled receivers keep their lane. Real samples (AWR2944) take one word each in the same order; the DC offset of the
ADC is removed. A wrong I/Q order reverses the range axis; the default is that of the radar (`lvds_iq_order`). In
advanced frames, words of other sub-frames are skipped on reading and written as zeros.

Reference: TI SWRA581B, mmWave Radar Device ADC Raw Data Capture.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.regular_files import check_regular
from mmweaver.core.safe_files.safe_arrays import read_words
from mmweaver.core.shapes import LostShare
from mmweaver.io.sample_files import MAX_OWN_ZEROS, SentBytes

IQ_ORDERS = ("iq", "qi", "interleaved")
INT16_MAX = 32767
GROWING = "parts.jsonl"  # present while a file grows (mmweaver generate --stream): a kill may truncate its last frame
LANES = 4  # of devices with more than two lanes
HEADROOM = 0.5  # largest word relative to full scale if `write_bin` chooses the scale


def read_bin(
    path: Path | str, config: RadarConfig, *, iq_order: str | None = None, frames: slice = slice(None)
) -> AdcCube:
    """Reads a recording.

    Args:
        path: The file.
        config: The radar, whose `tx_order` is the firing order of the recording.
        iq_order: One of IQ_ORDERS. Default: the radar's.
        frames: Range of frames. Default: all.

    Returns:
        Samples in ADC counts; the scale is unknown (nan).

    Raises:
        InputError: If the file cannot be read or has less than a frame, or the number of complex samples per chirp is
            odd.
    """
    _check(config, iq_order)
    chosen = range(num_frames_of_bin(path, config))[frames]
    frame_words = bytes_of_frame(config) // 2
    words = read_words(path, "<i2", count=len(chosen) * frame_words, first=chosen.start * frame_words)
    return adc_of_words(words, config, iq_order=iq_order)


def num_frames_of_bin(path: Path | str, config: RadarConfig) -> int:
    """Counts the frames of a recording.

    Args:
        path: The file.
        config: The radar.

    Returns:
        Number of complete frames.

    Raises:
        InputError: If the file has less than a frame.
    """
    path, size = Path(path), check_regular(path)
    if size < bytes_of_frame(config):
        raise InputError(not_whole_frames(path, size, config))
    return size // bytes_of_frame(config)


def not_whole_frames(path: Path, size: int, config: RadarConfig) -> str:
    """Sentence on a size that is no multiple of a frame's.

    Args:
        path: The file, or the first of its parts.
        size: Bytes that the radar sent.
        config: The radar.
    """
    if size == 0:
        return f"{path} is empty"
    frame_bytes = bytes_of_frame(config)
    channels = "4 lanes" if config.lvds_lanes == LANES else f"{config.num_rx} RX"
    layout = f"{config.num_loops} loops x {config.num_slots} TX x {channels} x {config.num_samples} samples x"
    layout += f" {2 * _num_parts(config)}"
    if others := config.frame_words_before + config.frame_words_after:
        layout += f" + {2 * others} of other sub-frames"
    return (
        f"{path} has {size} bytes: {size // frame_bytes} whole frames of {frame_bytes} bytes ({layout}) and"
        f" {size % frame_bytes} bytes more; the file is truncated or --radar is not the radar that recorded it"
    )


def bytes_of_frame(config: RadarConfig) -> int:
    """Bytes that a DCA1000 sends per radar frame, including other sub-frames."""
    return 2 * (_own_words(config) + config.frame_words_before + config.frame_words_after)


def _own_words(config: RadarConfig) -> int:
    channels = LANES if config.lvds_lanes == LANES else config.num_rx
    return config.num_loops * config.num_slots * channels * config.num_samples * _num_parts(config)


def _num_parts(config: RadarConfig) -> int:
    return 2 if config.complex_samples else 1


def _parts(words: np.ndarray, config: RadarConfig, iq_order: str | None) -> np.ndarray:
    """View of words (frame, word) as I and Q: (part, frame, loop, slot, receiver or lane, group, sample in group)."""
    head = (len(words), config.num_loops, config.num_slots)
    order = iq_order or config.lvds_iq_order
    if config.lvds_lanes == LANES:
        lanes = words.reshape(*head, config.num_samples, _num_parts(config), LANES)
        parts = np.moveaxis(lanes, (-2, -1), (0, -2))[..., None]
    elif config.complex_samples:
        pairs = words.reshape(*head, config.num_rx, config.num_samples // 2, 2, 2)
        parts = np.moveaxis(pairs.swapaxes(-1, -2) if order == "interleaved" else pairs, -2, 0)
    else:
        parts = words.reshape(1, *head, config.num_rx, config.num_samples, 1)
    return parts[::-1] if order == "qi" else parts


def _channels(config: RadarConfig) -> list[int]:
    """Positions of the radar's receivers on the channel axis of `_parts`."""
    is_laned = config.lvds_lanes == LANES
    return list(config.rx_channels) if is_laned and config.rx_channels else list(range(config.num_rx))


def adc_of_words(words: np.ndarray, config: RadarConfig, *, iq_order: str | None = None) -> AdcCube:
    """Decodes the words of complete frames as a DCA1000 sends them.

    Args:
        words: int16 words, (word,).
        config: The radar.
        iq_order: One of IQ_ORDERS. Default: the radar's.

    Returns:
        Samples in ADC counts.

    Raises:
        InputError: If the number of complex samples per chirp is odd.
    """
    _check(config, iq_order)
    first, last = config.frame_words_before, config.frame_words_before + _own_words(config)
    words = words.reshape(-1, bytes_of_frame(config) // 2)[:, first:last]
    shape = (len(words), config.num_loops, config.num_slots, config.num_rx, config.num_samples)
    parts = [part[..., _channels(config), :, :].reshape(shape) for part in _parts(words, config, iq_order)]
    if config.complex_samples:
        samples = np.empty(shape, np.complex64)
        samples.real, samples.imag = parts
    else:
        # windowed mean: a plain mean contains part of each echo, which would then appear at range 0 and fluctuate
        weight = 1 - np.cos(2 * np.pi * np.arange(config.num_samples) / config.num_samples)
        samples = (parts[0] - (parts[0] @ (weight / weight.sum()))[..., None]).astype(np.complex64)
    samples = upright(by_transmitter(samples, config), config)
    return AdcCube(samples=samples, config=config, scale=float("nan"))


def adc_of_sent(
    source: SentBytes, config: RadarConfig, frames: range, *, iq_order: str | None = None
) -> tuple[AdcCube, LostShare]:
    """Decodes complete frames of a byte stream.

    Args:
        source: The stream, read from its files on demand.
        config: The radar.
        frames: Indices of the frames, consecutive.
        iq_order: One of IQ_ORDERS. Default: the radar's.

    Returns:
        Samples in ADC counts, zero where lost, and the share of each chirp's samples that is lost, (frame, loop,
        slot).

    Raises:
        InputError: If the number of complex samples per chirp is odd.
    """
    _check(config, iq_order)
    frame_bytes = bytes_of_frame(config)
    data, is_received = source.read(frames.start * frame_bytes, frames.stop * frame_bytes)
    words = data.view("<i2")
    adc = adc_of_words(words, config, iq_order=iq_order)
    own = slice(config.frame_words_before, config.frame_words_before + _own_words(config))
    words, is_received = (
        one.reshape(len(frames), frame_bytes // 2)[:, own] for one in (words, is_received.reshape(-1, 2).all(axis=1))
    )
    # a signal that is mostly zero by itself, as of an empty simulated room, has long runs of zeros without any loss
    zeros = ((words == 0) & is_received).sum(axis=1)
    is_quiet = (zeros > MAX_OWN_ZEROS * is_received.sum(axis=1)) & is_received.any(axis=1)
    shape = (
        len(frames),
        config.num_loops,
        config.num_slots,
        _own_words(config) // config.num_loops // config.num_slots,
    )
    lost = 1 - is_received.reshape(shape).mean(axis=-1, dtype=np.float32)
    lost[is_quiet] = 0
    return adc, lost if config.is_coded else lost[:, :, np.argsort(config.tx_order)]


def write_bin(
    path: Path | str,
    adc: AdcCube,
    *,
    iq_order: str | None = None,
    tx_order: tuple[int, ...] | None = None,
    counts_per_unit: float | None = None,
) -> float:
    """Writes a recording for `read_bin` and TI's own tools.

    Args:
        path: The file.
        adc: The samples.
        iq_order: One of IQ_ORDERS. Default: the radar's.
        tx_order: Firing order in the file, for readers with a fixed one; the samples keep the timing of their radar.
            Default: the radar's.
        counts_per_unit: Scale. Default: the largest component reaches half of full scale.

    Returns:
        Counts per unit of the samples.

    Raises:
        InputError: If a sample is not finite or does not fit int16, the number of complex samples per chirp is odd, or
            the file cannot be written.
    """
    words, counts = words_of(adc, iq_order=iq_order, tx_order=tx_order, counts_per_unit=counts_per_unit)
    with atomic_file(Path(path)) as temporary:
        temporary.write_bytes(np.ascontiguousarray(words).data)  # numpy's own tofile hides why it failed
    return counts


def words_of(
    adc: AdcCube,
    *,
    iq_order: str | None = None,
    tx_order: tuple[int, ...] | None = None,
    counts_per_unit: float | None = None,
) -> tuple[np.ndarray, float]:
    """Encodes samples as words of a DCA1000; arguments as in `write_bin`.

    Returns:
        Little-endian int16 words, (frame, word), and the counts per unit of the samples.

    Raises:
        InputError: As in `write_bin`.
    """
    config = adc.config if tx_order is None else replace(adc.config, tx_order=tuple(tx_order))
    _check(config, iq_order)
    samples = upright(adc.samples if config.is_coded else adc.samples[:, :, list(config.tx_order)], config)
    parts = (np.real(samples), np.imag(samples))[: _num_parts(config)]
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
    words = np.zeros((len(samples), _own_words(config)), "<i2")
    for place, part in zip(_parts(words, config, iq_order), parts, strict=True):
        channels = _channels(config)
        counts = np.rint(part * np.float64(counts_per_unit))
        place[..., channels, :, :] = counts.reshape(*part.shape[:3], len(channels), *place.shape[-2:])
    around = ((0, 0), (config.frame_words_before, config.frame_words_after))
    return np.pad(words, around), float(counts_per_unit)


def by_transmitter(samples: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Reorders samples from firing order to transmitter number.

    Args:
        samples: Samples in firing order, (frame, loop, slot, rx, sample).
        config: The radar; slots of a coded radar keep their order.

    Returns:
        Samples, (frame, loop, tx, rx, sample).
    """
    return samples if config.is_coded else samples[:, :, np.argsort(config.tx_order)]


def upright(samples: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Inverts the receivers with inverted feed (`rx_inverted`); its own inverse.

    Args:
        samples: Samples, (..., rx, sample).
        config: The radar.

    Returns:
        Samples of the same shape.
    """
    if not config.rx_inverted:
        return samples
    sign = np.ones(config.num_rx, np.float32)
    sign[list(config.rx_inverted)] = -1
    return samples * sign[:, None]


def _check(config: RadarConfig, iq_order: str | None) -> None:
    """Raises InputError if a DCA1000 cannot record this radar or I/Q order."""
    is_paired = config.lvds_lanes != LANES and config.complex_samples
    if iq_order is not None and iq_order not in IQ_ORDERS:
        raise InputError(f"unknown I/Q order {iq_order!r}; known: {', '.join(IQ_ORDERS)}")
    if iq_order == "interleaved" and not is_paired:
        raise InputError(f"I/Q order 'interleaved' is for complex samples of two lanes, not for radar {config.name!r}")
    if config.lvds_lanes == 0:
        raise InputError(f"radar {config.name!r} is no board for a DCA1000, so there is no .bin of it; use .npy")
    if config.num_samples % 2 and is_paired:
        raise InputError(
            f"a DCA1000 file holds samples in pairs, but a chirp has {config.num_samples}; take an even number"
        )
