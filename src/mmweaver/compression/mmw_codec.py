"""Compresses a radar cube into a .mmw file and back; one step for all chunks meets a given size or error."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import ChunkEncoder, DecodedChunk, decode_chunk
from mmweaver.compression.mmw_container import MmwFile, MmwHeader, pack_mmw, unpack_mmw
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.fields.scatterers.fit_window import FitWindow, overlap_hop
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted

CHUNK_FRAMES = 20
BYTES_A_POINT = 6.0  # few, well-fitted scatterers are worth more than many: the residual is coded separately
POINTS_A_FRAME = 50
FIT_STAGES, LEAST_GAIN = 20, 12.0
LEAST_BYTES = 256
FINEST_STEP, COARSEST_STEP = 1e-7, 0.5
TRIALS = 9
BENT = 0.1  # trials whose log sizes differ by less are interpolated linearly
CLOSE_ENOUGH = 0.97  # of the bytes allowed
# first guess: the step that suits 500 bytes per frame, and its slope over the logarithm of the size
FIRST_STEP, FIRST_SLOPE, USUAL_BYTES = 3e-3, 1.2, 500
CLOSE_ENOUGH_DB = 0.1

Progress = Callable[[str], None]


def compress_cube(
    cube: RadarCube,
    *,
    num_bytes: int | None = None,
    quality_db: float | None = None,
    keep_noise: bool = False,
    progress: Progress = lambda _: None,
) -> bytes:
    """The bytes of a .mmw file: at most `num_bytes`, or with a signal-to-error ratio of `quality_db` in active cells.

    Cells without signal (less than 12 dB above the median power) may have 12 dB more error, and stay empty where they
    hold less than that; with `keep_noise` all cells have the same error. Raises InputError where the cube cannot be
    stored (values that are not finite, other axes than its radar's) or the request cannot be met.
    """
    if (num_bytes is None) == (quality_db is None):
        raise InputError("give either a number of bytes or a quality, not both")
    if num_bytes is not None and num_bytes < LEAST_BYTES:
        raise InputError(f"{num_bytes} bytes are too few; a .mmw file needs at least {LEAST_BYTES}")
    if quality_db is not None and not 1 <= quality_db <= 90:
        raise InputError(f"a quality of {quality_db:g} dB is not possible; choose 1 to 90")
    check_writable(cube)
    peak = float(np.abs(cube.values).max())
    parts = _chunks(len(cube.values))
    wanted = None if num_bytes is None else num_bytes / len(parts)
    encoders = []
    for number, part in enumerate(parts):
        progress(f"fitting frames {part[0]} to {part[-1]} ({number + 1} of {len(parts)})")
        encoders.append(_encoder(_some_frames(cube, part), peak, wanted, keep_noise))
    header = MmwHeader(
        config=cube.config, scale=cube.scale, frame_time_s=tuple(float(t) for t in cube.grid.frame_time_s),
        chunk_frames=tuple(len(part) for part in parts),
    )  # fmt: skip
    progress("writing")

    def written(step: float) -> list[bytes]:
        return [encoder.encode(step) for encoder in encoders]

    if num_bytes is not None:
        return _within_bytes(written, header, num_bytes)
    return pack_mmw(header, _within_error(written, cube, float(quality_db or 0)))


def read_cube(path: Path | str, frames: slice = slice(None), *, with_residual: bool = True) -> RadarCube:
    """Reads a .mmw file, or some of its frames, as a cube; only the required chunks are decoded.

    Raises InputError where the file is damaged or `frames` selects none of its frames.
    """
    file = MmwFile(path)
    header = file.header
    wanted = range(sum(header.chunk_frames))[frames]
    if not wanted:
        raise InputError(f"{path} has {sum(header.chunk_frames)} frames, and none of them is selected")
    values, first = [], 0
    for index, count in enumerate(header.chunk_frames):
        own = [frame - first for frame in wanted if first <= frame < first + count]
        if own:
            values.append(read_chunk(file, index, with_residual=with_residual).cube_values()[own])
        first += count
    grid = replace(grid_of_header(header), frame_time_s=np.array(header.frame_time_s)[list(wanted)])
    order = np.argsort(np.argsort(np.array(wanted), kind="stable"), kind="stable")
    joined = np.concatenate(values)
    joined = joined if wanted.step > 0 else joined[order]
    return RadarCube(values=joined, grid=grid, config=header.config, scale=header.scale)


def errors_db(data: bytes, cube: RadarCube) -> dict[str, float]:
    """Error-to-signal ratio in dB of a compressed cube against the original: in active cells, and in all cells."""
    header, chunks = unpack_mmw(data)
    again = np.concatenate([decode_chunk(chunk, header.config).cube_values() for chunk in chunks])
    is_active = active_cells(cube.values)
    return {
        "signal_error_db": round(_error_db(cube.values, again, is_active), 2),
        "all_error_db": round(_error_db(cube.values, again, np.ones_like(is_active)), 2),
    }


def read_chunk(file: MmwFile, index: int, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes one chunk of a file. Raises InputError where it is damaged."""
    chunk = decode_chunk(file.chunk(index), file.header.config, with_residual=with_residual)
    if chunk.fit_window.num_frames != file.header.chunk_frames[index]:
        raise InputError(f"{file.path} is damaged: chunk {index} has a wrong number of frames; compress it again")
    return chunk


def describe_mmw(path: Path | str) -> dict[str, Any]:
    """Describes a file by plain values; every chunk is decoded and checked. Raises InputError where it is damaged."""
    file = MmwFile(path)
    header, config = file.header, file.header.config
    chunks = []
    for index, size in enumerate(header.chunk_bytes):
        chunk = read_chunk(file, index)
        chunks.append(
            {
                "frames": chunk.fit_window.num_frames,
                "bytes": size,
                "scatterers": int(chunk.layers.counts().sum()),
                "has_static": bool((chunk.layers.static != 0).any()),
                "has_gains": bool((chunk.layers.calibration != 1).any()),
                "residual_values": chunk.num_residual_values,
                "noise_db": round(10 * math.log10(chunk.layers.noise_power), 2),
            }
        )
    shape = grid_of_header(header).shape
    return {
        "file": str(path),
        "bytes": file.num_bytes,
        "shape": list(shape),
        "scale": header.scale if math.isfinite(header.scale) else None,
        "first_frame_s": header.frame_time_s[0],
        "last_frame_s": header.frame_time_s[-1],
        "ratio": round(8 * math.prod(shape) / file.num_bytes, 1),
        "radar": {
            "name": config.name,
            "num_antennas": config.num_antennas,
            "range_resolution_m": config.range_resolution_m,
            "velocity_resolution_mps": config.velocity_resolution_mps,
        },
        "chunks": chunks,
    }


def grid_of_header(header: MmwHeader) -> CubeGrid:
    """The grid of all frames of a file."""
    grid = CubeGrid.of(header.config, len(header.frame_time_s))
    return replace(grid, frame_time_s=np.array(header.frame_time_s))


def check_writable(cube: RadarCube) -> None:
    """Raises InputError for a cube that a .mmw file cannot hold."""
    own = CubeGrid.of(cube.config, max(1, len(cube.values)))
    shape = (len(cube.values), *own.shape[1:])
    if cube.values.shape != shape or not len(cube.values):
        raise InputError(
            f"the cube has shape {cube.values.shape}, but radar {cube.config.name!r} makes {shape}; give the radar"
            " that recorded it"
        )
    for name in ("range_m", "radial_velocity_mps", "antenna_position_m"):
        if not np.allclose(getattr(cube.grid, name), getattr(own, name), rtol=1e-6, atol=1e-9):
            raise InputError(
                f"the cube's {name} is not that of radar {cube.config.name!r}; give the radar that made it"
            )
    if not np.isfinite(cube.values).all():
        raise InputError("the cube holds values that are not finite; repair the recording")
    if not np.any(cube.values):
        raise InputError("the cube is all zeros: there is nothing to compress")


def _chunks(num_frames: int) -> list[range]:
    return [range(first, min(first + CHUNK_FRAMES, num_frames)) for first in range(0, num_frames, CHUNK_FRAMES)]


def _some_frames(cube: RadarCube, part: Sequence[int]) -> RadarCube:
    chosen = slice(part[0], part[-1] + 1)
    grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[chosen])
    return replace(cube, values=cube.values[chosen], grid=grid)


def _encoder(cube: RadarCube, peak: float, wanted: float | None, keep_noise: bool) -> ChunkEncoder:
    frames = len(cube.values)
    fit_window = FitWindow.of(cube.config, frames, overlap_hop(cube))
    target = fit_window.working(cube.values / np.float32(peak))
    most = POINTS_A_FRAME * frames
    num_points = most if wanted is None else min(most, int(wanted / BYTES_A_POINT))
    # a single frame cannot separate static clutter from slow motion
    recipe = FitRecipe(
        num_points=num_points, with_static=frames > 1, with_calibration=True, stages=FIT_STAGES, least_gain=LEAST_GAIN
    )
    return ChunkEncoder(target, fit_window, fitted(target, fit_window, recipe), peak, keep_noise=keep_noise)


def _within_bytes(written: Callable[[float], list[bytes]], header: MmwHeader, num_bytes: int) -> bytes:
    """The finest step whose file fits: the size is roughly a power of the step, so interpolate and narrow down."""
    low, high = math.log(FINEST_STEP), math.log(COARSEST_STEP)
    best: bytes | None = None
    seen: list[tuple[float, float]] = []
    ample = num_bytes / (sum(header.chunk_frames) * USUAL_BYTES)
    guess = min(max(math.log(FIRST_STEP) - FIRST_SLOPE * math.log(ample), low), high)
    for _ in range(TRIALS):
        data = pack_mmw(header, written(math.exp(guess)))
        seen.append((guess, math.log(len(data) / num_bytes)))
        if len(data) <= num_bytes:
            best, high = data if best is None or len(data) > len(best) else best, guess
            if len(data) >= CLOSE_ENOUGH * num_bytes:
                break
        else:
            low = guess
        guess = _next_guess(seen, low, high)
    if best is None:
        best = pack_mmw(header, written(COARSEST_STEP))
    if len(best) > num_bytes:
        raise InputError(f"{num_bytes} bytes are too few for this recording; give at least {len(best)}")
    return best


def _next_guess(seen: list[tuple[float, float]], low: float, high: float) -> float:
    """Next step (log) to try: regula falsi between the trials on either side of zero, or bisection where it is slow.

    Aims slightly below zero. With trials on one side only: the line through the last two, or of the usual slope.
    """
    above = [trial for trial in seen if trial[1] > 0]
    below = [trial for trial in seen if trial[1] <= 0]
    if above and below:
        first, second = max(above), min(below)
        if min(first[1], -second[1]) > BENT and (seen[-1][1] > 0) == (seen[-2][1] > 0):
            return (first[0] + second[0]) / 2  # only one side moves: the curve is bent
    elif len(seen) > 1:
        first, second = seen[-2:]
    else:
        first, second = seen[0], (seen[0][0] + 1.0, seen[0][1] - 0.8)
    slope = min((second[1] - first[1]) / (second[0] - first[0]), -0.2)
    guess = first[0] + (-0.008 - first[1]) / slope
    edge = 0.03 * (high - low)
    return min(max(guess, low + edge), high - edge)


def _within_error(written: Callable[[float], list[bytes]], cube: RadarCube, quality_db: float) -> list[bytes]:
    """The coarsest step whose error-to-signal ratio in active cells is at most -quality_db."""
    is_active = active_cells(cube.values)
    low, high = math.log(FINEST_STEP), math.log(COARSEST_STEP)
    best: list[bytes] | None = None
    seen: list[tuple[float, float]] = []
    guess = math.log(0.02)
    for _ in range(TRIALS):
        data = written(math.exp(guess))
        again = np.concatenate([decode_chunk(chunk, cube.config).cube_values() for chunk in data])
        error_db = _error_db(cube.values, again, is_active)
        # treated like the size: too good is too large
        seen.append((guess, -(error_db + quality_db) / 10))
        if error_db <= -quality_db:
            best, low = data, guess
            if error_db >= -quality_db - CLOSE_ENOUGH_DB:
                break
        else:
            high = guess
        guess = _next_guess(seen, low, high)
    if best is None:
        raise InputError(f"a quality of {quality_db:g} dB cannot be reached; ask for less")
    return best


def _error_db(truth: CubeValues, ours: CubeValues, is_active: np.ndarray) -> float:
    error = np.sum(np.abs(truth - ours)[is_active] ** 2)
    return float(10 * np.log10(max(error, 1e-300) / np.sum(np.abs(truth)[is_active] ** 2)))
