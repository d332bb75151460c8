"""Word order of DCA1000 recordings: number of lanes and order of I and Q, checked on the samples.

Real echoes have positive beat frequencies and occupy few ranges. Another order is suggested only if the samples read
with it pass the same checks.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from mmweaver.core.records import AdcCube
from mmweaver.core.shapes import Array
from mmweaver.io.dca1000 import IQ_ORDERS, LANES, adc_of_words, words_of
from mmweaver.signal.windows import hann

MIRRORED_DB = 8.0  # excess energy in the last quarter of the beat frequencies over the first
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
    mirrored = {order: mirrored_db(_again(adc, iq_order, order)) for order in orders}
    first, second, *_ = sorted(orders, key=lambda order: mirrored[order])
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
