"""Compresses a radar cube to a .mmw file and decompresses it; one step for all chunks meets a given size or error."""

import math
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.chunk import DecodedChunk, decode_chunk
from mmweaver.compression.legacy_chunk import decode_legacy_chunk
from mmweaver.compression.mmw_container import LISTED, MAX_RATIO, MmwFile, header_for, pack_mmw
from mmweaver.compression.optimiser import Optimiser, Progress, error_db
from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import cannot_write
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import single_precision
from mmweaver.core.shapes import CubeValues

EFFORTS = "full", "fast"
MIN_BYTES = 256
FLOAT32_DB = -115.0  # error at the finest step, the rounding of float32
MAX_PEAK = 1e37  # sums over a window of values close to the largest float32 would not be finite


@single_precision()
def compress_cube(
    cube: RadarCube,
    *,
    num_bytes: int | None = None,
    quality_db: float | None = None,
    keep_noise: bool = False,
    effort: str = "full",
    progress: Progress = lambda _: None,
) -> bytes:
    """Compresses a cube; without loss where that fits into the bytes.

    Args:
        cube: The cube.
        num_bytes: Maximum size of the file; give either this or `quality_db`.
        quality_db: Signal-to-error ratio in active cells.
        keep_noise: Whether all cells have the same error; by default cells without signal (less than 12 dB above the
            median power) may have 12 dB more, and are dropped where they contain less than that.
        effort: "full", or "fast" without a fit of scatterers.
        progress: Called with the name of each step.

    Returns:
        The bytes of a .mmw file.

    Raises:
        InputError: If the cube cannot be stored (values that are not finite, axes other than those of its radar) or the
            request cannot be met.
    """
    check_encodable(cube, num_bytes, quality_db)
    header, time_s = header_for(cube.config, cube.scale, cube.grid.frame_time_s), cube.grid.frame_time_s

    def packed(parts: list[range], chunks: list[bytes]) -> bytes:
        return pack_mmw(header, chunks, [time_s[part.start : part.stop] for part in parts])

    parts, chunks = encoded(
        cube,
        lambda parts: len(packed(parts, [b""] * len(parts))),
        num_bytes=num_bytes,
        quality_db=quality_db,
        keep_noise=keep_noise,
        effort=effort,
        progress=progress,
    )
    missing = cube.values.nbytes // MAX_RATIO + 1 - sum(map(len, chunks))
    # readers distrust files that promise more; decoders ignore words of four bytes that follow
    chunks[-1] += bytes(4 * max(0, -(-missing // 4)))
    return packed(parts, chunks)


def check_request(num_bytes: int | None, quality_db: float | None) -> None:
    """Checks that a size or quality can be met by some file.

    Args:
        num_bytes: Size in bytes, or None.
        quality_db: Signal-to-error ratio in active cells, or None.

    Raises:
        InputError: If both or neither are given, or the value is out of range.
    """
    if (num_bytes is None) == (quality_db is None):
        raise InputError("give either a number of bytes or a quality, not both")
    if num_bytes is not None and num_bytes < MIN_BYTES:
        raise InputError(f"{num_bytes} bytes are too few; a .mmw file needs at least {MIN_BYTES}")
    if quality_db is not None and not 1 <= quality_db <= 90:
        raise InputError(f"a quality of {quality_db:g} dB is not possible; choose 1 to 90")


def encoded(
    cube: RadarCube,
    framing: Callable[[list[range]], int],
    *,
    num_bytes: int | None,
    quality_db: float | None,
    keep_noise: bool = False,
    effort: str = "full",
    progress: Progress = lambda _: None,
) -> tuple[list[range], list[bytes]]:
    """The chunks of a cube, as in `compress_cube`.

    Args:
        cube: The cube.
        framing: Bytes of the file in addition to its chunks, as a function of the frames of each.
        num_bytes: Maximum size of the file; give either this or `quality_db`.
        quality_db: Signal-to-error ratio in active cells.
        keep_noise: Whether all cells have the same error.
        effort: "full" or "fast".
        progress: Called with the name of each step.

    Returns:
        Frames and bytes of each chunk.
    """
    if effort not in EFFORTS:
        raise InputError(f"unknown effort {effort!r}; choose {' or '.join(EFFORTS)}")
    optimiser = Optimiser(cube, keep_noise=keep_noise, with_points=effort == "full")
    parts = optimiser.divide(num_bytes=num_bytes, quality_db=quality_db)
    if num_bytes is None:
        return parts, optimiser.within_error(float(quality_db or 0), progress)
    return parts, optimiser.within_bytes(num_bytes - framing(parts), progress)


@single_precision()
def read_cube(path: Path | str, frames: slice = slice(None), *, with_residual: bool = True) -> RadarCube:
    """Reads a .mmw file, or some of its frames, as a cube; only the required chunks are decoded.

    Args:
        path: Path of the file; of a truncated one, the frames of its complete chunks are read.
        frames: Frames to read; by default all.
        with_residual: Whether the residual is included; otherwise scatterers and static layer alone.

    Raises:
        InputError: If the file is damaged or `frames` selects none of its frames.
    """
    file = MmwFile(path)
    wanted = range(file.num_frames)[frames]
    if not wanted:
        raise InputError(f"{path} has {file.num_frames} frames, and none of them is selected")
    rising = wanted if wanted.step > 0 else wanted[::-1]
    values, first = [], 0
    for index, record in enumerate(file.records):
        last = first + record.num_frames
        own = [frame - first for frame in rising if first <= frame < last] if rising[-1] >= first else []
        if own:
            values.append(read_chunk(file, index, with_residual=with_residual).cube_values()[own])
        first = last
    joined = np.concatenate(values)
    grid = replace(grid_of_file(file), frame_time_s=file.frame_time_s[list(wanted)])
    header = file.header
    joined = joined if wanted.step > 0 else joined[::-1]
    return RadarCube(values=joined, grid=grid, config=header.config, scale=header.scale)


def errors_db(again: CubeValues, cube: RadarCube) -> dict[str, float]:
    """Error-to-signal ratios in dB of decoded values.

    Args:
        again: Decoded values (frame, range, doppler, antenna).
        cube: The original cube.

    Returns:
        `signal_error_db` in active cells, `all_error_db` in all cells.
    """
    is_active = active_mask(cube.values)
    return {
        "signal_error_db": round(error_db(cube.values, again, is_active), 2),
        "all_error_db": round(error_db(cube.values, again, np.ones_like(is_active)), 2),
    }


def values_of_bytes(data: bytes) -> CubeValues:
    """Values of the cube in the bytes of a .mmw file.

    Raises:
        InputError: If they are damaged.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.mmw"
        try:
            path.write_bytes(data)
        except OSError as error:
            raise cannot_write(path, error) from error
        return read_cube(path).values


def read_chunk(file: MmwFile, index: int, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes one chunk of a file.

    Args:
        file: The file.
        index: Index of the chunk.
        with_residual: Whether the residual is decoded.

    Raises:
        InputError: If the chunk is damaged.
    """
    decode = decode_legacy_chunk if file.version in LISTED else decode_chunk
    chunk = decode(file.payload(index), file.header.config, with_residual=with_residual)
    if chunk.frames.num_frames != file.records[index].num_frames:
        raise InputError(f"{file.path} is damaged: chunk {index} has a wrong number of frames; compress it again")
    return chunk


def describe_mmw(path: Path | str) -> dict[str, Any]:
    """Describes a .mmw file by plain values; every chunk is decoded and checked.

    Args:
        path: Path of the file.

    Raises:
        InputError: If the file is damaged.
    """
    file = MmwFile(path)
    header, config = file.header, file.header.config
    chunks = []
    for index, record in enumerate(file.records):
        chunk = read_chunk(file, index)
        layers = chunk.layers
        chunks.append(
            {
                "frames": record.num_frames,
                "bytes": record.num_bytes,
                "mode": chunk.mode_name(),
                "scatterers": 0 if layers is None else int(layers.counts().sum()),
                "has_static": layers is not None and bool((layers.static != 0).any()),
                "has_gains": layers is not None and bool((layers.calibration != 1).any()),
                "residual_values": chunk.num_residual_values,
                "step_db": round(20 * math.log10(chunk.step), 1) if chunk.step else None,
                "noise_db": round(10 * math.log10(chunk.noise_power), 2),
            }
        )
    shape = grid_of_file(file).shape
    time_s = file.frame_time_s
    return {
        "file": str(path),
        "version": file.version,
        "bytes": file.num_bytes,
        "cut_short_bytes": file.cut_short,
        "shape": list(shape),
        "scale": header.scale if math.isfinite(header.scale) else None,
        "first_frame_s": float(time_s[0]),
        "last_frame_s": float(time_s[-1]),
        "ratio": round(8 * math.prod(shape) / file.num_bytes, 1),
        "radar": {
            "name": config.name,
            "num_antennas": config.num_antennas,
            "range_resolution_m": config.range_resolution_m,
            "velocity_resolution_mps": config.velocity_resolution_mps,
        },
        "chunks": chunks,
    }


def grid_of_file(file: MmwFile) -> CubeGrid:
    """The grid of all frames of a file."""
    grid = CubeGrid.of(file.header.config, file.num_frames)
    return replace(grid, frame_time_s=file.frame_time_s)


def check_encodable(cube: RadarCube, num_bytes: int | None, quality_db: float | None) -> None:
    """Checks cube and request of a compression.

    Args:
        cube: The cube.
        num_bytes: Maximum size of the file, or None.
        quality_db: Signal-to-error ratio in active cells, or None.

    Raises:
        InputError: For a request that no file meets or that readers would reject, and for an unsuitable cube.
    """
    check_request(num_bytes, quality_db)
    check_writable(cube)
    if num_bytes is not None and num_bytes * MAX_RATIO < cube.values.nbytes:
        least = -(-cube.values.nbytes // MAX_RATIO)
        raise InputError(f"{num_bytes} bytes are too few; {len(cube.values)} frames need at least {least}")


def check_writable(cube: RadarCube) -> None:
    """Checks that a .mmw file can store a cube.

    Raises:
        InputError: If its shape or axes are not those of its radar, or values are not finite or too large.
    """
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
    if np.abs(cube.values).max() > MAX_PEAK:
        raise InputError(f"the cube holds values above {MAX_PEAK:g}, where float32 ends; scale them down")
