"""Consistency of samples and settings of a recording, with a more likely interpretation if they disagree.

Real echoes have positive beat frequencies, chirps of one transmitter resemble each other, transmitters see static
echoes consistently with their positions, and approaching targets have negative radial velocity. Each check uses a few
frames only.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from mmweaver.core.boards import ANTENNAS, PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.shapes import PerFrame
from mmweaver.io.dca1000 import upright
from mmweaver.io.radar_options import RadarOptions
from mmweaver.recordings.frame_boundaries import agreements, loops_of_other_frames, wrong_iq_order, wrong_lanes
from mmweaver.signal.cube import remove_static
from mmweaver.signal.spectra import range_doppler_power

FRAMES_LOOKED_AT = 8
PROBE_BYTES = 1 << 16
FULL_SCALE = 32767
CLIPPED_SHARE = 1e-3
MIN_CLIPPED = 1000  # counts; at low amplitude many samples share the largest value without clipping
OTHER_SIZE = 0.5  # ratio of mean magnitudes below which another number type is more likely
MIN_LIKENESS = 0.4  # minimum correlation of chirps one loop apart
BETTER_LIKENESS = 0.25  # minimum advantage of another layout
NO_LIKENESS = 0.05  # correlation in noise, or with an unknown packing
MIN_ORDER = 0.3  # minimum agreement of static echoes with a transmitter order to count as evidence
FITTING = 0.6  # minimum agreement of static echoes with the true antennas
BETTER_BOARD = 0.15  # minimum advantage of another board's antennas
BETTER_ORDER = 0.06  # minimum advantage of another transmitter order
SAME_LIKENESS = 0.05
COMMON_SAMPLES = (64, 96, 100, 128, 200, 240, 256, 304, 320, 384, 400, 512)
OTHER_PERIOD = 0.15  # relative deviation of the frame period
MIN_MOVING_FRAMES = 6
MIN_TRAVEL = 6.0  # minimum integrated velocity in range bins: hands and a swaying trunk travel less
UNFOLDED = 0.6  # of the unambiguous velocity; faster movement may alias to the other sign


def implausible(
    adc: AdcCube,
    cube: RadarCube,
    path: Path | None = None,
    *,
    iq_order: str | None = None,
    frame_time_s: PerFrame | None = None,
) -> list[str]:
    """Checks whether samples and settings of a recording agree.

    Args:
        adc: Raw samples.
        cube: Radar cube.
        path: .bin from which the samples were read. Default: not checked.
        iq_order: I/Q order with which int16 words were read. Default: not from int16 words.
        frame_time_s: Arrival times of the frames' packets in seconds, (frame,). Default: unknown.

    Returns:
        One sentence per deviation, with the more likely interpretation; empty if all is plausible.
    """
    few = replace(adc, samples=adc.samples[:FRAMES_LOOKED_AT])
    if found := [*_number_type(path)]:
        return found  # a wrong number type invalidates every other check
    found = [*_values(adc)]
    if any("constant" in text for text in found):
        return found  # not enough signal for further checks
    layout = [*wrong_lanes(few, iq_order)] or [*_layout(few), *_period(adc.config, frame_time_s)]
    layout = layout or [*wrong_iq_order(few, iq_order)]  # meaningless if the chirp layout is wrong
    layout = layout or [*loops_of_other_frames(adc)]
    return [*found, *(layout or [*_transmitters(cube), *_velocity_sign(cube)])]


def other_layout(adc: AdcCube, iq_order: str | None) -> str:
    """A more likely chirp layout or number of lanes, as a sentence; "" if the radar's fits.

    Args:
        adc: Raw samples of a few frames.
        iq_order: I/Q order with which int16 words were read.
    """
    return "; ".join([*wrong_lanes(adc, iq_order), *_layout(adc)])


def _number_type(path: Path | None) -> Iterator[str]:
    """Detects files of other number types that were read as int16."""
    if path is None or path.suffix.lower() not in (".bin", ".dat", ".raw"):
        return
    with open_regular(path) as stream:
        head = stream.read(PROBE_BYTES)
    if kind := _integers(np.frombuffer(head[: len(head) // 4 * 4], "<i2")):
        yield f"the file seems to hold {kind}, but was read as int16; convert it with numpy"
        return
    for kind, name in (("<f8", "float64 or complex128"), ("<f4", "float32 or complex64")):
        values = np.frombuffer(head[: len(head) // 8 * 8], kind)
        with np.errstate(all="ignore"):
            size = np.abs(values[values != 0])
            is_sane = np.isfinite(size) & (size > 1e-9) & (size < 1e9)
        if (
            len(size) >= 0.25 * max(len(values), 1) and is_sane.mean() > 0.999
        ):  # a quarter, since real or imaginary parts may be 0
            yield (
                f"the file seems to hold numbers of type {name}, but was read as int16; load it with numpy, save it as"
                " .npy and give --layout"
            )
            return


def _integers(words: np.ndarray) -> str:
    """Other integer type that int16 words more likely represent; "" for none."""
    low, high = words[0::2].astype(int), words[1::2].astype(int)
    if np.ptp(low) and (high == np.where(low < 0, -1, 0)).mean() > 0.99:
        return "numbers of type int32"
    words = words[np.abs(words.astype(int)) < FULL_SCALE]
    own = np.abs(words.astype(int)).mean() if len(words) else 0.0
    if np.abs(words.byteswap().astype(int)).mean() < OTHER_SIZE * own:
        return "big-endian numbers"
    if np.abs((words ^ np.int16(-32768)).astype(int)).mean() < OTHER_SIZE * own:
        return "numbers of type uint16 around 32768"
    return ""


def _values(adc: AdcCube) -> Iterator[str]:
    """Detects constant frames and clipped samples."""
    spread = np.array([np.ptp(np.abs(frame)) for frame in adc.samples[:, ::8]])
    if still := int((spread == 0).sum()):
        yield f"{still} of {len(spread)} frames are constant: lost data, or a file that was filled up"
    few = adc.samples[:FRAMES_LOOKED_AT]
    parts = np.concatenate([np.real(few).ravel(), np.imag(few).ravel()])
    most = np.abs(parts).max(initial=0)
    is_counts = np.isnan(adc.scale) and most >= MIN_CLIPPED and adc.config.complex_samples
    clipped = float((np.abs(parts) >= most - 1).mean()) if is_counts else 0.0
    if clipped > CLIPPED_SHARE:
        at = "full scale" if most >= FULL_SCALE else f"{most:.0f} counts"
        yield f"{100 * clipped:.1f} % of the samples are clipped at {at}; record with less receiver gain"


def _layout(adc: AdcCube) -> Iterator[str]:
    """Checks the chirp layout: in any room, chirps of one transmitter one loop apart resemble each other.

    If they also resemble each other after half a loop, and more than chirps of different antennas do, the loop was read
    twice as long as it is.
    """
    config = adc.config
    if config.num_loops < 2:
        return
    stream = adc.samples if config.is_coded else adc.samples[:, :, list(config.tx_order)]
    flat = upright(stream, config).reshape(len(stream), -1)  # in recorded order
    loop = config.num_slots * config.num_rx * config.num_samples
    kinds = (flat, flat.mean(axis=0)[None])  # the mean over frames suppresses moving echoes
    layouts: dict[int, list[tuple[int, int, int]]] = {}
    for slots, rx, samples in product((1, 2, 3, 4), (1, 2, 3, 4), sorted({*COMMON_SAMPLES, config.num_samples})):
        if (lag := slots * rx * samples) * 4 <= flat.shape[1]:
            layouts.setdefault(lag, []).append((slots, rx, samples))
    likeness = {lag: np.array([_likeness(kind, lag) for kind in kinds]) for lag in {*layouts, loop}}
    alike = {lag: float(values.max()) for lag, values in likeness.items()}
    gain = {lag: float((values - likeness[loop]).max()) for lag, values in likeness.items()}
    own, best = alike[loop], max((alike[lag] for lag in layouts), default=0.0)
    if max(own, best) < NO_LIKENESS:
        yield (
            f"chirps one loop ({loop} samples) apart are alike to {own:.2f}, and no other layout has more: noise"
            " alone, no samples, or samples packed in another way"
        )
        return
    if own >= MIN_LIKENESS and max((gain[lag] for lag in layouts), default=0.0) <= BETTER_LIKENESS:
        kinds, few = (flat[:2],), flat[:2]
        alike = {lag: _likeness(few, lag) for lag in layouts if lag < loop and loop % lag == 0}
        likely = [lag for lag, found in alike.items() if found > own - SAME_LIKENESS]
        if not likely:
            return
        lag = min(likely)
        chirps = [config.num_samples * number for number in range(1, config.num_slots * config.num_rx)]
        beyond = float(np.median([_likeness(few, one) for one in chirps if one % lag] or [1.0]))
        is_likelier = alike[lag] > beyond + BETTER_LIKENESS
    else:
        lag = min((one for one in layouts if alike[one] > best - SAME_LIKENESS), default=loop)
        is_likelier = alike[lag] > own + BETTER_LIKENESS or gain[lag] > BETTER_LIKENESS
    if is_likelier:
        own_layout = (config.num_slots, config.num_rx, config.num_samples)

        def merit(layout: tuple[int, int, int]) -> tuple[int, bool, bool, float, int]:
            same = [one == own for one, own in zip(layout, own_layout, strict=True)]
            chirp = max(_likeness(kind, layout[2]) for kind in kinds)
            return sum(same), _presets(*layout) != "", same[2], round(chirp, 1), -layout[0]

        slots, rx, samples = max(layouts[lag], key=merit)
        yield (
            f"chirps one loop ({loop} samples) apart are alike to {own:.2f}, but {lag} samples apart to"
            f" {alike[lag]:.2f}, as with {slots} TX x {rx} RX x {samples} samples{_presets(slots, rx, samples)};"
            " --radar is probably not the radar that recorded it"
        )


def _presets(slots: int, rx: int, samples: int) -> str:
    """Presets with this loop layout, in brackets."""
    found = [
        name
        for name, radar in PRESETS.items()
        if (radar.num_slots, radar.num_rx, radar.num_samples) == (slots, rx, samples)
    ]
    return f" (presets: {', '.join(found)})" if found else ""


def _period(config: RadarConfig, frame_time_s: PerFrame | None) -> Iterator[str]:
    """Compares packet arrival times with the frame period."""
    if frame_time_s is None or len(frame_time_s) < 3:
        return
    period_s = float(np.median(np.diff(frame_time_s)))
    if abs(period_s / config.frame_period_s - 1) > OTHER_PERIOD:
        yield (
            f"the packets of a frame came every {1e3 * period_s:.1f} ms, the frames of this radar every"
            f" {1e3 * config.frame_period_s:.1f} ms; --radar is probably not the radar that recorded it"
        )


def _likeness(flat: np.ndarray, lag: int) -> float:
    """Normalised correlation of a stream with itself at a lag.

    Args:
        flat: Samples in recorded order, (frame, sample).
        lag: Lag in samples.

    Returns:
        Magnitude from 0 to 1.
    """
    before, after = flat[:, :-lag], flat[:, lag:]
    common = np.abs(np.vdot(before, after))
    return float(common / max(np.linalg.norm(before) * np.linalg.norm(after), 1e-300))


def _transmitters(cube: RadarCube) -> Iterator[str]:
    """Searches for another board or transmitter order that agrees better with the static echoes.

    Another board is considered only if no order of the radar's own antennas fits.
    """
    own = cube.config.tx_order
    cube = replace(cube, values=cube.values[:FRAMES_LOOKED_AT])
    found = agreements(cube)
    best = max(found, key=lambda order: found[order], default=own)
    boards = _agreements_of_boards(cube) if found and found[best] < FITTING else {}
    board = max(boards, key=lambda name: boards[name], default="")
    if boards and boards[board] > max(found[best] + BETTER_BOARD, FITTING):
        yield (
            f"static echoes fit the antennas of board {board} to {boards[board]:.2f}, those of this radar to"
            f" {found[own]:.2f}; try --radar-set antennas={board}, or another --radar"
        )
        return
    if found and found[best] > max(found[own] + BETTER_ORDER, MIN_ORDER):
        yield (
            f"the transmitters fit the static echoes to {found[own]:.2f} in the order {','.join(map(str, own))}, to"
            f" {found[best]:.2f} in the order {','.join(map(str, best))}; try another --radar or --tx-order"
            f" {','.join(map(str, best))}"
        )


def _agreements_of_boards(cube: RadarCube) -> dict[str, float]:
    """Agreement of the static echoes with each board of equal antenna count, in the radar's own order."""
    config, fits = cube.config, {}
    for name, table in ANTENNAS.items():
        if (len(table.tx_halfwaves), len(table.rx_halfwaves)) != (config.num_tx, config.num_rx):
            continue
        other = RadarOptions(antennas=table).applied(config)
        turned = [
            -1.0 if (rx in config.rx_inverted) != (rx in other.rx_inverted) else 1.0 for rx in range(other.num_rx)
        ]
        values = cube.values * np.tile(np.array(turned, np.float32), config.num_virtual_tx)
        fits[name] = agreements(replace(cube, values=values, config=other)).get(config.tx_order, 0.0)
    return fits


def _velocity_sign(cube: RadarCube) -> Iterator[str]:
    """Approaching targets must have negative radial velocity, unless they may alias."""
    config = cube.config
    if config.num_loops < 8 or len(cube.values) < MIN_MOVING_FRAMES:
        return
    power = range_doppler_power(remove_static(cube))
    level = power.sum(axis=(1, 2))
    speed = (power * cube.grid.radial_velocity_mps).sum(axis=(1, 2)) / np.maximum(level, 1e-300)
    place = (power.sum(axis=2) * cube.grid.range_m).sum(axis=1) / np.maximum(level, 1e-300)
    travelled = np.diff(place)
    steady_mps = np.abs(np.convolve(travelled, np.ones(3) / 3, "valid")) / config.frame_period_s
    if np.percentile(steady_mps, 75) > UNFOLDED * np.abs(cube.grid.radial_velocity_mps).max():
        return
    expected = (speed[1:] + speed[:-1]) / 2 * config.frame_period_s
    if np.ptp(np.cumsum(expected)) < MIN_TRAVEL * config.range_resolution_m:
        return
    sure = np.abs(expected) > 0.2 * config.range_resolution_m
    if sure.sum() < MIN_MOVING_FRAMES - 1:
        return
    agreement = float((travelled[sure] * expected[sure]).sum() / (expected[sure] ** 2).sum())
    if agreement < -0.5:
        yield (
            "echoes that come nearer have positive radial velocities: the loops of a frame are probably in reverse"
            " order, or I and Q the other way round"
        )
