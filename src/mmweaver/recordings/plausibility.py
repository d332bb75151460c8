"""Whether samples and settings of a recording fit each other, and the likelier reading where they do not.

Real echoes have a positive beat frequency, chirps of one transmitter resemble each other, transmitters see static
echoes as their neighbours do, and what comes nearer has a negative radial velocity. Each check looks at a few frames.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from mmweaver.core.presets import ANTENNAS, PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.shapes import PerFrame
from mmweaver.io.dca1000 import upright
from mmweaver.io.radar_options import RadarOptions
from mmweaver.recordings.frame_boundaries import loops_of_other_frames
from mmweaver.recordings.transmitter_order import agreements
from mmweaver.recordings.word_order import wrong_iq_order, wrong_lanes
from mmweaver.signal.cube import remove_static
from mmweaver.signal.spectra import range_doppler_power

FRAMES_LOOKED_AT = 8
PROBE_BYTES = 1 << 16
FULL_SCALE = 32767
CLIPPED_SHARE = 1e-3
MIN_CLIPPED = 1000  # counts; of a few counts many samples have the largest
OTHER_SIZE = 0.5  # times the mean size of the words, below which another type is likelier
MIN_LIKENESS = 0.4  # of chirps one loop apart
BETTER_LIKENESS = 0.25  # that another layout must have more
NO_LIKENESS = 0.05  # of chirps in noise, or of samples packed in a way that is not known
MIN_ORDER = 0.3  # how well static echoes must fit an order of transmitters to be evidence
FITTING = 0.6  # how well static echoes fit the right antennas at least
BETTER_BOARD = 0.15  # that another board's antennas must fit better
BETTER_ORDER = 0.06  # that another order of transmitters must fit static echoes better
SAME_LIKENESS = 0.05
COMMON_SAMPLES = (64, 96, 100, 128, 200, 240, 256, 304, 320, 384, 400, 512)
OTHER_PERIOD = 0.15  # of the time between frames
MIN_MOVING_FRAMES = 6
MIN_TRAVEL = 6.0  # range bins that velocities must add up to: hands and a swaying trunk move by less
UNFOLDED = 0.6  # of the unambiguous velocity: what travels faster may be seen with the other sign


def implausible(
    adc: AdcCube,
    cube: RadarCube,
    path: Path | None = None,
    *,
    iq_order: str | None = None,
    frame_time_s: PerFrame | None = None,
) -> list[str]:
    """What does not fit in a recording, with the likelier reading.

    Args:
        adc: Its samples.
        cube: Its cube.
        path: The .bin that the samples come from.
        iq_order: As which they were read, of int16 words.
        frame_time_s: When packets of the frames arrived, (frame,).

    Returns:
        A sentence each; empty where all is plausible.
    """
    few = replace(adc, samples=adc.samples[:FRAMES_LOOKED_AT])
    if found := [*_number_type(path)]:
        return found  # other numbers make every other check meaningless
    found = [*_values(adc)]
    if any("constant" in text for text in found):
        return found  # too little to check more
    layout = [*wrong_lanes(few, iq_order)] or [*_layout(few), *_period(adc.config, frame_time_s)]
    layout = layout or [*wrong_iq_order(few, iq_order)]  # meaningless for another radar's chirps
    layout = layout or [*loops_of_other_frames(adc)]
    return [*found, *(layout or [*_transmitters(cube), *_velocity_sign(cube)])]


def _number_type(path: Path | None) -> Iterator[str]:
    """Files of other numbers read as int16."""
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
        if len(size) >= 0.25 * max(len(values), 1) and is_sane.mean() > 0.999:  # a quarter: parts may be 0
            yield (
                f"the file seems to hold numbers of type {name}, but was read as int16; load it with numpy, save it as"
                " .npy and give --layout"
            )
            return


def _integers(words: np.ndarray) -> str:
    """Which other whole numbers int16 words are likelier to be; "" for none."""
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
    """Constant frames and clipped samples."""
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
    """Chirps of one transmitter, one loop apart, resemble each other in any room; else the layout is another.

    Where they resemble each other after half a loop, too, and more than chirps of different antennas do, the loop is
    read twice as long as it is.
    """
    config = adc.config
    if config.num_loops < 2:
        return
    stream = adc.samples if config.is_coded else adc.samples[:, :, list(config.tx_order)]
    flat = upright(stream, config).reshape(len(stream), -1)  # as the converter gave them
    loop = config.num_slots * config.num_rx * config.num_samples
    kinds = (flat, flat.mean(axis=0)[None])  # in the mean over frames moving echoes count less
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
    """Which presets have such loops, in brackets."""
    found = [
        name
        for name, radar in PRESETS.items()
        if (radar.num_slots, radar.num_rx, radar.num_samples) == (slots, rx, samples)
    ]
    return f" (presets: {', '.join(found)})" if found else ""


def _period(config: RadarConfig, frame_time_s: PerFrame | None) -> Iterator[str]:
    """Packets tell when frames came."""
    if frame_time_s is None or len(frame_time_s) < 3:
        return
    period_s = float(np.median(np.diff(frame_time_s)))
    if abs(period_s / config.frame_period_s - 1) > OTHER_PERIOD:
        yield (
            f"the packets of a frame came every {1e3 * period_s:.1f} ms, the frames of this radar every"
            f" {1e3 * config.frame_period_s:.1f} ms; --radar is probably not the radar that recorded it"
        )


def _likeness(flat: np.ndarray, lag: int) -> float:
    """Mean normalised correlation of a stream (frame, sample) with itself a lag later."""
    before, after = flat[:, :-lag], flat[:, lag:]
    common = np.abs(np.vdot(before, after))
    return float(common / max(np.linalg.norm(before) * np.linalg.norm(after), 1e-300))


def _transmitters(cube: RadarCube) -> Iterator[str]:
    """Another board's antennas or another order of transmitters, which fit the static echoes better."""
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
    """How well the static echoes fit the antennas of each board with as many, in the radar's own order."""
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
    """What comes nearer in range must have negative radial velocities, unless it may be too fast for the radar."""
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
