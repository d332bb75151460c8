"""Detection of a wrong number of loops per frame, from moving echoes.

Loops follow each other within about a millisecond, frames within tens of milliseconds. A moving echo rotates by the
same phase from loop to loop within a frame, but by an arbitrary phase across the pause between frames. If every second
step between frames looks like those within, two frames are actually one; if steps within a frame vary as much as those
between frames, a frame is actually several. Static echoes and frames without a pause carry no evidence.

Firing order of the transmitters of a TDM-MIMO recording, estimated from static echoes.

Receivers of one transmitter are sampled in the same chirp, so their correlation at each baseline is correct in any
order. Antennas of two transmitters at the same baseline must show the same correlation, cell by cell, up to a phase
common to all cells (channel errors); in a wrong order they do not. Receivers in one row carry no information on height,
whose phase is then treated as common to all cells as well; receivers in two rows (AOP, ODS) also distinguish
transmitters above one another. Unlike a plane-wave fit, this tolerates several scatterers per cell.

Word order of DCA1000 recordings: number of lanes and order of I and Q, checked on the samples.

Real echoes have positive beat frequencies and occupy few ranges. Another order is suggested only if the samples read
with it pass the same checks.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.shapes import Array
from mmweaver.io.dca1000 import IQ_ORDERS, LANES, adc_of_words, words_of
from mmweaver.signal.windows import hann

MIRRORED_DB = 8.0  # excess energy in the last quarter of the beat frequencies over the first
GATHERED = 0.98  # ratio of occupied range bins below which another pairing of I and Q is possible
LIKELIER_DB = 6.0  # minimum advantage over any other order for or against I Q I Q
SCATTERED = 0.75  # ratio of occupied range bins below which the other lane layout is more likely
WRITTEN = {"iq": "I I Q Q", "qi": "Q Q I I", "interleaved": "I Q I Q"}


def wrong_lanes(adc: AdcCube, iq_order: str | None) -> Iterator[str]:
    """Detects words of two lanes read as four, or vice versa, which scatters the spectrum of each chirp.

    Args:
        adc: Samples as read.
        iq_order: I/Q order with which int16 words were read; None if not from int16 words.

    Yields:
        A sentence if the other number of lanes is more likely.
    """
    config = adc.config
    if iq_order in (None, "interleaved") or config.num_rx != LANES or not config.complex_samples:
        return
    two = _alone(replace(adc, samples=adc.samples[:2]))
    other = 2 if config.lvds_lanes == LANES else LANES
    if _occupied(_again(two, iq_order, iq_order, lanes=other)) < SCATTERED * _occupied(two):
        yield (
            f"read as {other} lanes the echoes of a chirp gather at fewer ranges than as {config.lvds_lanes}; try"
            f" --radar-set lanes={other}, or another --radar"
        )


def wrong_iq_order(adc: AdcCube, iq_order: str | None) -> Iterator[str]:
    """Detects swapped or interleaved I and Q.

    Args:
        adc: Samples as read.
        iq_order: I/Q order with which int16 words were read; None if not from int16 words.

    Yields:
        A sentence if another order is more likely.
    """
    if not adc.config.complex_samples:
        return
    if iq_order is None:
        if mirrored_db(adc) > MIRRORED_DB:
            yield (
                f"{mirrored_db(adc):.0f} dB more energy lies at negative beat frequencies than at positive ones, so I"
                " and Q are probably the other way round; store the complex conjugate"
            )
        return
    adc = _alone(adc)
    orders = IQ_ORDERS if adc.config.lvds_lanes != LANES else IQ_ORDERS[:2]
    if "interleaved" in orders:  # the wrong pairing of words doubles each echo
        two = replace(adc, samples=adc.samples[:2])
        pairs, single = (_occupied(_again(two, iq_order, order)) for order in ("iq", "interleaved"))
        orders = tuple(
            order for order in orders if order == iq_order or (single < GATHERED * pairs) == (order == "interleaved")
        )
    mirrored = {order: mirrored_db(_again(adc, iq_order, order)) for order in orders}
    first, *others = sorted(orders, key=lambda order: mirrored[order])
    second = others[0] if others else first
    is_likelier = mirrored[first] < mirrored[second] - LIKELIER_DB
    if first == "interleaved" and not is_likelier:
        first = second
    if first == iq_order or not (
        mirrored[iq_order] > MIRRORED_DB or ("interleaved" in (first, iq_order) and is_likelier)
    ):
        return
    yield (
        "energy at negative beat frequencies over that at positive ones:"
        f" {mirrored[iq_order]:+.0f} dB read as {WRITTEN[iq_order]}, {mirrored[first]:+.0f} dB read as"
        f" {WRITTEN[first]}; try --iq-order {first}"
    )


def mirrored_db(adc: AdcCube) -> float:
    """Compares energy at negative and positive beat frequencies.

    Args:
        adc: Raw samples.

    Returns:
        Energy within a quarter of the sample rate below zero relative to that above zero, in dB.
    """
    level = _power(adc).mean(axis=(0, 1, 2, 3))
    num = adc.config.num_samples
    near = max(num // 4, 3)
    positive, negative = level[2:near].sum(), level[num - near + 1 : num - 1].sum()
    return float(10 * np.log10(max(negative, 1e-300) / max(positive, 1e-300)))


def _power(adc: AdcCube) -> Array:
    return np.abs(np.fft.fft(adc.samples * hann(adc.config.num_samples), axis=-1)) ** 2


def _alone(adc: AdcCube) -> AdcCube:
    """The samples as a recording without other sub-frames."""
    return replace(adc, config=replace(adc.config, frame_words_before=0, frame_words_after=0))


def _again(adc: AdcCube, iq_order: str, other: str, *, lanes: int | None = None) -> AdcCube:
    """The samples that result from reading the same words in another order or number of lanes."""
    words, _ = words_of(adc, iq_order=iq_order)
    config = adc.config if lanes is None else replace(adc.config, lvds_lanes=lanes)
    return adc_of_words(words.reshape(-1), config, iq_order=other)


def _occupied(adc: AdcCube) -> float:
    """Effective share of the range bins occupied by the energy of a chirp, averaged over chirps."""
    power = _power(adc)
    power = power.reshape(-1, power.shape[-1])
    return float((power.sum(axis=1) ** 2 / np.maximum((power**2).sum(axis=1), 1e-300)).mean() / power.shape[1])


CLEAR = 30.0  # static cells: minimum power relative to other velocities
MIN_CELLS = 12
Baseline = tuple[float, float]  # horizontal and vertical, in half wavelengths


def agreements(cube: RadarCube) -> dict[tuple[int, ...], float]:
    """Agreement of transmitters and receivers for each possible firing order.

    Args:
        cube: The cube, read in the order of its radar.

    Returns:
        Agreement from 0 to 1 by order; empty without evidence (one transmitter, a coded radar, too few static cells).
    """
    config = cube.config
    still = _static_cells(cube)
    if config.is_coded or config.num_tx < 2 or len(still) < MIN_CELLS:
        return {}
    signal = still.reshape(-1, config.num_tx, config.num_rx)
    fired, found = list(config.tx_order), {}
    for order in permutations(range(config.num_tx)):
        moved = np.empty_like(signal)
        moved[:, list(order)] = signal[:, fired]  # assigns the slot of transmitter fired[s] to order[s]
        found[order] = _agreement(moved, config)
    return found


def _static_cells(cube: RadarCube) -> np.ndarray:
    """Static cells (cell, antenna), each normalised to unit norm for equal weight."""
    middle = cube.config.num_loops // 2
    still = cube.values[:, :, middle].mean(axis=0)
    power = (np.abs(still) ** 2).sum(axis=1)
    others = np.median((np.abs(cube.values) ** 2).sum(axis=3).mean(axis=0), axis=1)
    chosen = power > (CLEAR * others if cube.config.num_loops >= 8 else 0)
    return still[chosen] / np.sqrt(power[chosen])[:, None]


def _agreement(signal: np.ndarray, config: RadarConfig) -> float:
    """Coherence of baselines between transmitters with those within one, from cells (cell, tx, rx)."""
    place = (2 * config.antenna_position_m / config.wavelength_m).reshape(*signal.shape[1:], 3)[..., [0, 2]]
    within = _correlations(signal, place, [(tx, tx) for tx in range(config.num_tx)])
    one_row = all(up == 0 for _, up in within)
    agreed = possible = 0.0
    for tx in range(config.num_tx):
        for other in range(tx):
            sums: dict[float, tuple[complex, float]] = {}
            for (across, up), value in _correlations(signal, place, [(tx, other)]).items():
                own = within.get((across, up))
                left_up = 0.0
                if own is None and one_row:
                    left_up, own = up, within.get((across, 0.0))
                if own is not None:
                    so_far, most = sums.get(left_up, (0j, 0.0))
                    size = np.linalg.norm(value) * np.linalg.norm(own)
                    sums[left_up] = so_far + np.vdot(own, value), most + float(size)
            agreed += sum(abs(value) for value, _ in sums.values())
            possible += sum(most for _, most in sums.values())
    return float(agreed / max(possible, 1e-300))


def _correlations(signal: np.ndarray, place: np.ndarray, pairs: list[tuple[int, int]]) -> dict[Baseline, np.ndarray]:
    """Products of antenna pairs (cell,) by baseline, averaged over receivers and pairs of transmitters."""
    found: dict[Baseline, list[np.ndarray]] = {}
    for tx, other in pairs:
        for one in range(signal.shape[2]):
            for two in range(signal.shape[2]):
                across, up = np.round(place[tx, one] - place[other, two], 1) + 0.0
                product = signal[:, tx, one] * signal[:, other, two].conj()
                found.setdefault((float(across), float(up)), []).append(product)
    return {baseline: np.mean(products, axis=0) for baseline, products in found.items()}


FRAMES = 48  # maximum number of frames examined
PARTS = (2, 3, 4)
JUMP = 4.0  # minimum ratio of the change across a pause to that within a frame
MIN_CHANGE = 0.05  # relative to the power of moving echoes: changes within a frame are smaller
MIN_STEPS = 4  # steps of each kind


def loops_of_other_frames(adc: AdcCube) -> Iterator[str]:
    """Checks the number of loops per frame.

    Args:
        adc: Raw samples.

    Yields:
        A sentence if the recording probably has more or fewer loops per frame than its radar.
    """
    loops = adc.config.num_loops
    if loops < 2:
        return
    chirps = adc.samples[:FRAMES, :, 0]  # one transmitter
    within, between = _changes(chirps.reshape(len(chirps), loops, -1))
    for parts in PARTS:
        if (
            loops % parts == 0
            and loops > 2 * parts
            and len(between) >= MIN_STEPS
            and _is_several(within, between, parts)
        ):
            yield _advice(loops, loops // parts, "echoes that move jump within each frame")
            return
    for parts in PARTS:
        if len(between) >= MIN_STEPS * parts and _is_part(within, between, parts):
            yield _advice(loops, loops * parts, "echoes that move go on from one frame to the next without a pause")
            return


def _changes(stream: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Deviation of each step (frame, loop) from the typical one of its frame, and of each step to the next frame."""
    num_frames, loops = stream.shape[:2]
    flat = stream.reshape(num_frames * loops, -1)
    flat = flat - flat.mean(axis=0)
    power = max(float((np.abs(flat) ** 2).sum(axis=1).mean()), 1e-300)
    step = np.append((flat[:-1].conj() * flat[1:]).sum(axis=1) / power, 0).reshape(num_frames, loops)
    inside, own = step[:, :-1], np.median(step[:, :-1].real, axis=1) + 1j * np.median(step[:, :-1].imag, axis=1)
    return np.abs(inside - own[:, None]) ** 2, np.abs(step[:-1, -1] - own[:-1]) ** 2


def _is_several(within: np.ndarray, between: np.ndarray, parts: int) -> bool:
    """Whether the steps at the boundaries of `parts` equal pieces of a frame jump like those between frames."""
    loops = within.shape[1] + 1
    seams = [number * loops // parts - 1 for number in range(1, parts)]
    typical = np.median(within, axis=0)
    rest = max(np.median(np.delete(typical, seams)), MIN_CHANGE)
    return bool(typical[seams].min() > max(JUMP * rest, np.median(between) / JUMP))


def _is_part(within: np.ndarray, between: np.ndarray, parts: int) -> bool:
    """Whether only every `parts`-th step between frames jumps, so that `parts` frames are one."""
    is_last = np.arange(len(between)) % parts == parts - 1
    small = np.median(between[~is_last])
    is_small = small < JUMP / 2 * max(np.median(within), MIN_CHANGE)
    return bool(is_small and np.median(between[is_last]) > JUMP * max(small, MIN_CHANGE))


def _advice(own: int, likely: int, why: str) -> str:
    return f"{why}: the frames of the recording probably have {likely} loops, not {own}; --radar is probably another"
