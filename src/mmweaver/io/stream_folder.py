"""A growing recording: subfolders of a few frames each, written in sequence and readable at any time.

    OUT/radar.json, meta.json        radar and metadata common to all parts; meta.json has the final frame count
    OUT/parts/00000000/              radar.npz, points.npz, pose.npz, radar.json, SHA256SUMS of the frames from 0 on
    OUT/parts.jsonl                  one line per part: first frame, number of frames, sentence, assumptions
    OUT/adc_data.bin                 raw samples of all frames, if requested
    OUT/SHA256SUMS                   of these files, once the stream has ended

A part is renamed into place when it is completely on disk, so a kill leaves complete parts only. Memory use does not
grow with the length. Reference: docs/decisions/streams.md.
"""

import json
import math
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import append_line, atomic_file, opened_to_append, staged_folder
from mmweaver.core.checksums import SUMS_FILE, write_sums
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import cannot_write
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube
from mmweaver.core.safe_files.safe_text import parse_json, read_text
from mmweaver.core.staging import remove, sync
from mmweaver.io.dca1000 import words_of
from mmweaver.io.npz_files import read_radar_npz, write_points_npz, write_pose_npz, write_radar_npz
from mmweaver.io.result_folder import plain

PARTS, LIST, BIN, META = "parts", "parts.jsonl", "adc_data.bin", "meta.json"
LARGEST_BYTES = 8_000_000_000  # of a cube read at once


def is_stream(folder: Path) -> bool:
    """Whether a folder contains a recording in parts."""
    return (folder / PARTS).is_dir() and (folder / LIST).is_file()


def parts_of(folder: Path) -> list[Path]:
    """Lists the complete parts of a recording.

    Args:
        folder: The recording.

    Returns:
        Folders of the parts in order.

    Raises:
        InputError: If there is none yet.
    """
    found = sorted(part for part in (folder / PARTS).iterdir() if part.is_dir() and part.name.isdecimal())
    if not found:
        raise InputError(f"{folder} holds no whole part yet; let the stream run longer")
    return found


def listed_parts(folder: Path) -> list[Path]:
    """Lists the parts named in parts.jsonl; an incomplete last line, left by a kill, is skipped.

    Args:
        folder: The recording.

    Returns:
        Folders of the parts.

    Raises:
        InputError: If parts.jsonl cannot be read.
    """
    found = []
    for line in read_text(folder / LIST).splitlines():
        try:
            found.append(folder / PARTS / f"{int(parse_json(line, LIST)['first_frame']):08d}")
        except (InputError, KeyError, TypeError, ValueError):
            continue
    return found


def read_stream_cube(folder: Path, frames: slice = slice(None)) -> RadarCube:
    """Reads frames of a recording as one cube; parts outside the range are not read.

    Args:
        folder: The recording.
        frames: Range of frames. Default: those of all complete parts.

    Returns:
        The cube.

    Raises:
        InputError: If a part is missing or damaged, no frame is selected, or the cube is larger than 8 GB.
    """
    first, last = frames.start or 0, math.inf if frames.stop is None else frames.stop
    parts = parts_of(folder)
    starts = [int(part.name) for part in parts]
    parts = [
        part
        for part, start, end in zip(parts, starts, [*starts[1:], math.inf], strict=True)
        if start < last and end > first
    ]
    size = sum((part / "radar.npz").stat().st_size for part in parts)
    if size > LARGEST_BYTES:
        raise InputError(f"{folder} holds {size / 1e9:.0f} GB; read its parts one by one, such as {parts[0]}")
    cubes, at = [], int(parts[0].name) if parts and first else 0
    skipped = first - at
    for part in parts:
        if int(part.name) != at:
            raise InputError(f"{folder}: the part that begins with frame {at} is missing")
        cubes.append(read_radar_npz(part / "radar.npz"))
        at += len(cubes[-1].values)
    if at <= first:
        raise InputError(f"{folder} holds {at} frames, and none of them is selected")
    one = cubes[0]
    values = np.concatenate([cube.values for cube in cubes])[skipped : min(last, at) - first + skipped]
    grid = one.grid.of(one.config, len(values), first)
    return RadarCube(values=values, grid=grid, config=one.config, scale=one.scale)


def num_frames_of_stream(folder: Path) -> int:
    """Number of frames of all complete parts.

    Args:
        folder: The recording.

    Raises:
        InputError: If there is no complete part.
    """
    last = parts_of(folder)[-1]
    return int(last.name) + len(read_radar_npz(last / "radar.npz").values)


class StreamFolder:
    """Writes a recording in parts: `add` for each part, then `finish`."""

    def __init__(self, out: Path, meta: dict[str, Any], *, iq_order: str | None = None) -> None:
        """Starts a recording; files are written with the first part.

        Args:
            out: The folder.
            meta: Content of meta.json common to all parts.
            iq_order: I/Q order of adc_data.bin. Default: the radar's.
        """
        self.out, self.meta, self.iq_order = out, meta, iq_order
        self.frames, self.parts, self.skipped = 0, 0, 0
        self._counts: float | None = None

    def add(
        self,
        cube: RadarCube,
        points: PointCloud,
        poses: tuple[PoseSequence, ...],
        adc: AdcCube | None,
        said: dict[str, Any],
    ) -> None:
        """Writes one more part.

        Args:
            cube: Cube of the part.
            points: Its point cloud.
            poses: People at its frames.
            adc: Its raw samples, or None.
            said: Further entries of its line in parts.jsonl, such as the sentence.

        Raises:
            InputError: If it cannot be written.
        """
        try:
            self._add(cube, points, poses, adc, said)
        except BaseException:
            if not self.parts:  # nothing whole is there
                for name in (PARTS, "radar.json", META, BIN, LIST):
                    remove(self.out / name)
            raise

    def _add(
        self,
        cube: RadarCube,
        points: PointCloud,
        poses: tuple[PoseSequence, ...],
        adc: AdcCube | None,
        said: dict[str, Any],
    ) -> None:
        if not self.parts:
            self._write_text("radar.json", cube.config.to_json())
            self._write_meta()
        with staged_folder(self.out / PARTS / f"{self.frames:08d}") as stage:
            write_radar_npz(stage / "radar.npz", cube)
            write_points_npz(stage / "points.npz", points)
            write_pose_npz(stage / "pose.npz", *poses)
            (stage / "radar.json").write_text(cube.config.to_json(), encoding="utf-8")
        if adc is not None:
            self._append_samples(adc)
        line = {"first_frame": self.frames, "frames": len(cube.values), **plain(said)}
        append_line(self.out / LIST, json.dumps(line, ensure_ascii=False, allow_nan=False))
        self.frames, self.parts = self.frames + len(cube.values), self.parts + 1

    def finish(self) -> dict[str, Any]:
        """Completes meta.json and writes the checksums.

        Returns:
            Content of meta.json.
        """
        self._write_meta()
        with atomic_file(self.out / SUMS_FILE) as temporary:
            write_sums(self.out, names=("radar.json", META, LIST, BIN), target=temporary)
        return plain(self._meta())

    def _append_samples(self, adc: AdcCube) -> None:
        own = adc.scale / adc.config.adc_count_sqrt_mw
        self.iq_order = self.iq_order or adc.config.lvds_iq_order
        words, self._counts = words_of(adc, iq_order=self.iq_order, counts_per_unit=own)
        try:
            with opened_to_append(self.out / BIN) as file:
                file.write(words.tobytes())
                file.flush()
                os.fsync(file.fileno())
            if not self.parts:
                sync(self.out)
        except OSError as error:
            raise cannot_write(self.out / BIN, error) from error

    def _meta(self) -> dict[str, Any]:
        samples = {}
        if self._counts is not None:
            samples = {"adc_data_bin": {"iq_order": self.iq_order, "counts_per_unit": self._counts}}
        return {**self.meta, "frames": self.frames, "parts": self.parts, **samples}

    def _write_meta(self) -> None:
        self._write_text(META, json.dumps(plain(self._meta()), indent=2, allow_nan=False, ensure_ascii=False) + "\n")

    def _write_text(self, name: str, text: str) -> None:
        with atomic_file(self.out / name) as temporary:
            temporary.write_text(text, encoding="utf-8")


def sentences_of(lines: Iterable[str]) -> Iterable[str]:
    """Yields stripped lines as they arrive, without empty lines and comments (#)."""
    for line in lines:
        text = line.strip()
        if text and not text.startswith("#"):
            yield text
