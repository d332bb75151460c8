"""Detection matrix of TI's demo, its CFAR in range and Doppler on integer logarithms, and its peak grouping."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Complex, Float, Int

from mmweaver.core.firmware_settings import FirmwareCfar, FirmwareSettings

DB_PER_OCTAVE = 20 * np.log10(2)

Level = Int[np.ndarray, "range doppler"]


@dataclass(frozen=True, kw_only=True)
class DetectionMatrix:
    """Detection matrix in the device's integer format.

    Attributes:
        level: (frame, range, doppler), log2 of the geometric mean of the antennas' magnitudes times
            `counts_per_octave`.
        counts_per_octave: Counts per factor of two in magnitude.
    """

    level: Int[np.ndarray, "frame range doppler"]
    counts_per_octave: float


def counts_per_db(device: str, num_antennas: int) -> float:
    """Threshold counts per dB.

    Args:
        device: "xwr14xx" or "xwr16xx".
        num_antennas: Number of virtual antennas.

    >>> round(1280 / counts_per_db("xwr14xx", 8), 1), round(1280 / counts_per_db("xwr14xx", 12), 1)
    (15.1, 20.1)
    """
    octave = (
        256.0 * num_antennas if device == "xwr16xx" else 512.0 * num_antennas / 2 ** (num_antennas - 1).bit_length()
    )
    return float(octave / DB_PER_OCTAVE)


def reported_share(device: str, num_antennas: int) -> float:
    """Reported dB per dB of level, in the side information of SDK 3 (TLV 7).

    The firmware of "xwr16xx" and later devices divides the sum over the antennas by the next power of two, corrects the
    threshold for that, but not the reported SNR and noise: with twelve antennas 10 dB are reported as 7.5 dB.

    Args:
        device: "xwr14xx" or "xwr16xx".
        num_antennas: Number of virtual antennas.

    >>> reported_share("xwr16xx", 12), reported_share("xwr16xx", 8)
    (0.75, 1.0)
    """
    return num_antennas / (1 << (num_antennas - 1).bit_length()) if device == "xwr16xx" else 1.0


def detection_matrix(spectrum: Complex[np.ndarray, "frame range doppler antenna"], device: str) -> DetectionMatrix:
    """Sum of the antennas' log2 magnitudes: Q8 ("xwr16xx"), or Q9 divided by a power of two ("xwr14xx").

    Args:
        spectrum: Range-Doppler spectrum in counts, (frame, range, doppler, antenna).
        device: "xwr14xx" or "xwr16xx".
    """
    num = spectrum.shape[-1]
    octaves = np.log2(np.maximum(np.abs(spectrum), 1))  # the device's logarithm of 0 is 0
    if device == "xwr16xx":
        level = np.floor(octaves * 256).astype(np.int64).sum(axis=-1)
        return DetectionMatrix(level=np.minimum(level, 65535), counts_per_octave=256.0 * num)
    shift = (num - 1).bit_length()
    level = np.floor(octaves * 2048).astype(np.int64).sum(axis=-1) >> (shift + 2)  # Q11 to Q9
    return DetectionMatrix(level=level, counts_per_octave=512.0 * num / 2**shift)


def cfar_detections(
    level: Level, settings: FirmwareSettings, counts_per_octave: float
) -> tuple[Bool[np.ndarray, "range doppler"], Float[np.ndarray, "range doppler"], Float[np.ndarray, "range doppler"]]:
    """Applies every CFAR stage of the settings.

    Args:
        level: Detection matrix (range, doppler) of one frame.
        settings: Settings of the firmware.
        counts_per_octave: As in `DetectionMatrix`.

    Returns:
        Mask (range, doppler) of the cells that pass all stages, their level in dB over the noise of the first stage,
        and this noise in dB of one count.
    """
    passed = np.ones(level.shape, bool)
    first: np.ndarray | None = None
    for cfar, is_doppler in ((settings.range_cfar, False), (settings.doppler_cfar, True)):
        if cfar is None:
            continue
        half = cfar.window // 2 if settings.device == "xwr14xx" else cfar.window
        # Doppler is tested in FFT order, so a non-cyclic CFAR ends at the fastest velocities
        line = np.fft.ifftshift(level, axes=1).T if is_doppler else level
        noise = noise_level(line, cfar, half)
        noise = np.fft.fftshift(noise.T, axes=1) if is_doppler else noise
        excess = level - noise
        passed &= excess > cfar.threshold
        first = noise if first is None else first
    assert first is not None, "FirmwareSettings has at least one CFAR"
    count_db = DB_PER_OCTAVE / counts_per_octave
    return passed, (level - first) * count_db, first * count_db


def noise_level(level: Int[np.ndarray, "along across"], cfar: FirmwareCfar, half: int) -> Int[np.ndarray, "along _"]:
    """Noise level at each cell along the first axis, from `half` cells on either side beyond the guard cells.

    "ca" shifts the sum of both sides right by `noise_shift`, "caso" and "cago" the smaller or greater side by one bit
    less. Without `cyclic`, a cell near one end uses the other side only; if both sides are missing, its noise is
    infinite.

    Args:
        level: Detection matrix (along, across).
        cfar: Settings of the stage.
        half: Number of training cells on either side.

    Returns:
        Noise level (along, across), integers.
    """
    num = len(level)
    reach = cfar.guard + half
    running = np.concatenate([np.zeros_like(level[:1]), np.cumsum(_padded(level, reach, cfar.cyclic), axis=0)])
    at = np.arange(num)
    before = running[at + half] - running[at]
    start = at + reach + cfar.guard + 1
    after = running[start + half] - running[start]
    one_side = cfar.noise_shift - 1
    if cfar.average == "ca":
        noise = (before + after) >> cfar.noise_shift
    elif cfar.average == "caso":
        noise = np.minimum(before, after) >> one_side
    else:
        noise = np.maximum(before, after) >> one_side
    if not cfar.cyclic:
        has_before, has_after = at >= reach, at < num - reach
        noise = np.where((has_before & ~has_after)[:, None], before >> one_side, noise)
        noise = np.where((has_after & ~has_before)[:, None], after >> one_side, noise)
        noise = np.where((has_after | has_before)[:, None], noise, np.iinfo(np.int32).max)
    return noise


def _padded(level: np.ndarray, reach: int, cyclic: bool) -> np.ndarray:
    """The level padded cyclically, or with zeros."""
    padding = ((reach, reach), (0, 0))
    return np.pad(level, padding, mode="wrap") if cyclic else np.pad(level, padding)


def is_local_peak(level: Level, settings: FirmwareSettings) -> Bool[np.ndarray, "range doppler"]:
    """Cells within the configured range bins that no neighbour exceeds.

    Neighbours are the eight around with grouping in range and Doppler, the two along the one direction that is grouped,
    none without grouping. Doppler is cyclic; cells outside the configured range bins are ignored.

    Args:
        level: Detection matrix (range, doppler) of one frame.
        settings: Settings of the firmware.

    Returns:
        Mask (range, doppler).
    """
    rows = np.arange(len(level))
    inside = (rows >= settings.first_range_bin) & (rows <= settings.last_range_bin)
    kept = np.where(inside[:, None], level, -1)
    padded = np.pad(kept, ((1, 1), (0, 0)), constant_values=-1)
    along_range = (-1, 0, 1) if settings.group_range else (0,)
    along_doppler = (-1, 0, 1) if settings.group_doppler else (0,)
    peak = np.broadcast_to(inside[:, None], level.shape).copy()
    for row in along_range:
        for column in along_doppler:
            peak &= kept >= np.roll(padded[1 + row : 1 + row + len(level)], -column, axis=1)
    return peak
