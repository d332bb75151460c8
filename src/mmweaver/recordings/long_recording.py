"""Recordings of any length in bounded memory: cube, points and what the analysis needs, block by block, on disk.

Each block is a whole number of the blocks that `radar_cube` and `micro_doppler` work in, and everything that is kept of
it follows from its frames alone, so the results are those of the whole recording at once, to the bit. A finished block
is never computed again: after an interruption the same command goes on with the next one.

    WORK/state.json      what the blocks are of; other blocks are deleted
    WORK/cube.bin        complex64 (frame, range, doppler, antenna) of the blocks so far
    WORK/00000000.npz    of each block, by its first frame: points, values at zero Doppler, power, losses
"""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.constants import __version__
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.io.npz_files import DiskCube, write_npz
from mmweaver.recordings.analysis import RecordingAnalysis, recording_analysis
from mmweaver.recordings.read_recording import Recording
from mmweaver.signal.doppler_spectrogram import (
    FRAMES_A_BLOCK,
    MicroDoppler,
    chirp_levels,
    frame_powers,
    moving_bins,
    spectrogram_of_frames,
    window_loops_of,
)
from mmweaver.signal.points import point_cloud
from mmweaver.signal.slow_time import zero_doppler
from mmweaver.signal.spectra import moving_doppler, range_doppler_power

BLOCK_BYTES = 48e6  # of the complex samples of a block
LONG_BYTES = 400e6  # of the complex samples of a recording that is processed in blocks
STATE, CUBE = "state.json", "cube.bin"
POINTS = ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
Progress = Callable[[int, int], object]


@dataclass(frozen=True, kw_only=True)
class Blocks:
    """How a recording is cut and processed.

    Attributes:
        read: Reads frames.
        finish: Cube and points of what was read.
        num_frames: Frames of the recording.
        analyse: Whether the analysis is wanted.
    """

    read: Callable[[slice], Recording]
    finish: Callable[[Recording], tuple[RadarCube, PointCloud]]
    num_frames: int
    analyse: bool


def block_frames(config: Any) -> int:
    """Frames of a block: a multiple of FRAMES_A_BLOCK."""
    frame_bytes = 8 * config.num_loops * config.num_slots * config.num_rx * config.num_samples
    return max(1, int(BLOCK_BYTES / frame_bytes / FRAMES_A_BLOCK)) * FRAMES_A_BLOCK


def is_long(config: Any, num_frames: int) -> bool:
    """Whether a recording is processed in blocks."""
    return num_frames * 8 * config.num_loops * config.num_slots * config.num_rx * config.num_samples > LONG_BYTES


class LongRecording:
    """Blocks of a recording in a work folder."""

    def __init__(self, work: Path, blocks: Blocks, identity: dict[str, Any]):
        """Opens the work folder and deletes blocks of anything else.

        Args:
            work: The folder, which is made.
            blocks: How the recording is cut.
            identity: What the results depend on.
        """
        self.work, self.blocks = work, blocks
        identity = {**identity, "version": __version__, "frames": blocks.num_frames}
        state = json.dumps(identity, sort_keys=True, default=str)
        file = work / STATE
        if not file.is_file() or file.read_text(encoding="utf-8") != state:
            work.mkdir(parents=True, exist_ok=True)
            for one in (*work.glob("*.npz"), work / CUBE):
                one.unlink(missing_ok=True)
            file.write_text(state, encoding="utf-8")
        self.resumed_from = sum(1 for _ in work.glob("[0-9]*.npz"))

    def run(self, progress: Progress) -> None:
        """Computes the blocks that are missing.

        Args:
            progress: Called with frames done and all frames.
        """
        first = self.blocks.read(slice(0, 1))
        step, total = block_frames(first.config), self.blocks.num_frames
        for start in range(0, total, step):
            stop = min(start + step, total)
            done = self.work / f"{start:08d}.npz"
            if not done.is_file():
                self._block(done, start, stop)
            progress(stop, total)

    def _block(self, done: Path, start: int, stop: int) -> None:
        found = self.blocks.read(slice(start, stop))
        whole = found.cube
        cube, points = self.blocks.finish(found)
        values = np.ascontiguousarray(cube.values, np.complex64)
        with (self.work / CUBE).open("r+b" if (self.work / CUBE).is_file() else "wb") as file:
            file.seek(start * values[0].nbytes)
            values.tofile(file)
        power = range_doppler_power(whole)
        arrays = {name: np.asarray(getattr(points, name)) for name in POINTS}
        arrays["frame"] = arrays["frame"] + start
        arrays |= {"still": zero_doppler(whole), "power": power.sum(axis=1)}
        if self.blocks.analyse:
            moving = moving_doppler(whole).sum() >= 2
            people = point_cloud(whole, moving_only=True) if moving else None
            if people is not None:
                arrays |= {f"moving_{name}": np.asarray(getattr(people, name)) for name in POINTS}
                arrays["moving_frame"] = arrays["moving_frame"] + start
            if found.adc is not None and window_loops_of(found.config) is not None:
                arrays["chirp_level"] = chirp_levels(found.adc)
        if found.lost_share is not None:
            arrays["lost_share"] = found.lost_share
        if found.packets is not None:
            arrays["frame_clock_s"] = found.packets.frame_time_s
        with atomic_file(done) as temporary:
            write_npz(temporary, **arrays)

    def column(self, name: str) -> np.ndarray | None:
        """An array of all blocks; None if they do not have it."""
        found = []
        for file in sorted(self.work.glob("[0-9]*.npz")):
            with np.load(file) as held:
                if name not in held:
                    return None
                found.append(held[name])
        return np.concatenate(found)

    def points(self, prefix: str = "") -> PointCloud | None:
        """Points of all blocks."""
        columns = {name: self.column(prefix + name) for name in POINTS}
        if any(one is None for one in columns.values()):
            return None
        return PointCloud(**{name: one for name, one in columns.items() if one is not None})

    def cube(self, one: RadarCube) -> RadarCube:
        """The cube of all blocks, on disk.

        Args:
            one: Cube of some frames, for its axes.
        """
        shape = (self.blocks.num_frames, *one.values.shape[1:])
        values: Any = DiskCube(self.work / CUBE, np.complex64, "r", shape=shape)
        still = self.column("still")
        assert still is not None
        values.still = still
        return replace(one, values=values, grid=CubeGrid.of(one.config, shape[0]))

    def analysis(self, cube: RadarCube) -> RecordingAnalysis:
        """The analysis of all blocks, see `analyse_recording`."""
        power = self.column("power")
        still = self.column("still")
        assert power is not None
        assert still is not None
        view = np.broadcast_to(still[:, :, None], (len(still), still.shape[1], cube.config.num_loops, still.shape[2]))
        return recording_analysis(replace(cube, values=view), self._micro_doppler(cube), self.points("moving_"), power)

    def _micro_doppler(self, cube: RadarCube) -> MicroDoppler | None:
        levels, width = self.column("chirp_level"), window_loops_of(cube.config)
        if levels is None or width is None:
            return None
        span, powers, step = moving_bins(levels), [], block_frames(cube.config)
        for start in range(0, self.blocks.num_frames, step):
            adc = self.blocks.read(slice(start, min(start + step, self.blocks.num_frames))).adc
            assert adc is not None
            powers.append(frame_powers(adc, width, span))
        return spectrogram_of_frames(adc, width, span, np.concatenate(powers))
