"""A recording that grows: folders of some frames each, written one after the other, readable at any time.

    OUT/radar.json, meta.json        the radar, and what all parts share; meta.json counts the frames at the end
    OUT/parts/00000000/              radar.npz, points.npz, pose.npz, radar.json, SHA256SUMS of the frames from 0 on
    OUT/parts.jsonl                  a line a part: first frame, frames, sentence, what was assumed
    OUT/adc_data.bin                 raw samples of all frames, where they are asked for
    OUT/SHA256SUMS                   of these files, once the stream has ended

A part gets its name when all of it is on the disk, so that a kill leaves whole parts. Memory does not grow with the
length. Reference: docs/decisions/streams.md.
"""

import json
import math
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import append_line, atomic_file, staged_folder
from mmweaver.core.checksums import SUMS_FILE, write_sums
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import cannot_write
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube
from mmweaver.core.safe_files.safe_text import parse_json, read_text
from mmweaver.core.staging import sync
from mmweaver.io.dca1000 import words_of
from mmweaver.io.npz_files import read_radar_npz, write_points_npz, write_pose_npz, write_radar_npz
from mmweaver.io.result_folder import plain

PARTS, LIST, BIN, META = "parts", "parts.jsonl", "adc_data.bin", "meta.json"
LARGEST_BYTES = 8_000_000_000  # of a cube that is read at once


def is_stream(folder: Path) -> bool:
    """Whether a folder holds a recording in parts."""
    return (folder / PARTS).is_dir() and (folder / LIST).is_file()


def parts_of(folder: Path) -> list[Path]:
    """The whole parts of a recording in their order. Raises InputError where there is none, or one is missing."""
    found = sorted(part for part in (folder / PARTS).iterdir() if part.is_dir() and part.name.isdecimal())
    if not found:
        raise InputError(f"{folder} holds no whole part yet; let the stream run longer")
    return found


def listed_parts(folder: Path) -> list[Path]:
    """The parts that parts.jsonl lists; a kill may have left half a line at its end. Raises InputError."""
    found = []
    for line in read_text(folder / LIST).splitlines():
        try:
            found.append(folder / PARTS / f"{int(parse_json(line, LIST)['first_frame']):08d}")
        except (InputError, KeyError, TypeError, ValueError):
            continue
    return found


def read_stream_cube(folder: Path, frames: slice = slice(None)) -> RadarCube:
    """The frames of all whole parts, or a stretch of them, as one cube; parts without any of them are not read.

    Raises InputError where a part is missing or damaged, or memory does not hold the cube.
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
    """Number of frames of all whole parts. Raises InputError where there is none."""
    last = parts_of(folder)[-1]
    return int(last.name) + len(read_radar_npz(last / "radar.npz").values)


class StreamFolder:
    """Writes a recording in parts; `add` one after the other, then `finish`."""

    def __init__(self, out: Path, meta: dict[str, Any], *, iq_order: str | None = None) -> None:
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
        """Writes one more part. Raises InputError where it cannot be written."""
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
        """Writes how long it became, and the checksums; returns the content of meta.json."""
        self._write_meta()
        with atomic_file(self.out / SUMS_FILE) as temporary:
            write_sums(self.out, names=("radar.json", META, LIST, BIN), target=temporary)
        return plain(self._meta())

    def _append_samples(self, adc: AdcCube) -> None:
        own = adc.scale / adc.config.adc_count_sqrt_mw
        self.iq_order = self.iq_order or adc.config.lvds_iq_order
        words, self._counts = words_of(adc, iq_order=self.iq_order, counts_per_unit=own)
        try:
            with (self.out / BIN).open("ab") as file:
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
    """The sentences of lines as they come: empty ones and those that begin with # are left out."""
    for line in lines:
        text = line.strip()
        if text and not text.startswith("#"):
            yield text
