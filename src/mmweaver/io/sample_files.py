"""The bytes that a DCA1000 sent, in order, whatever files hold them, and which of them were received.

A recording longer than 1 GB is split into X_Raw_0.bin, X_Raw_1.bin, ...: parts of one stream, cut anywhere. DCA1000 and
mmWave Studio fill lost packets with zeros, 1456 bytes each; other recorders leave them out, so that all later bytes lie
too early in the file (`missing_packets` finds where).
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_regular, foreign_errors, open_regular

PACKET_BYTES = 1456  # payload of a full packet
MIN_ZEROS = PACKET_BYTES // 4  # words: a run of half a packet is no signal
MAX_OWN_ZEROS = 0.5  # share of zeros among the other words; above, the signal itself is zero
PART = re.compile(r"^(.*_Raw_)(\d+)(\.bin)$", re.IGNORECASE)


@runtime_checkable
class SentBytes(Protocol):
    """Byte stream of a DCA1000; `size` counts the bytes that were sent."""

    size: int

    def read(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Bytes from `first` to `last`, uint8, with zeros in place of lost ones, and whether each was received."""
        ...


class JoinedFiles:
    """Several files read as one."""

    def __init__(self, paths: tuple[Path, ...]):
        self.paths = paths
        self._ends = np.cumsum([check_regular(path) for path in paths])
        self.size = int(self._ends[-1])

    def read(self, first: int, last: int) -> np.ndarray:
        """Bytes from `first` to `last`, uint8; fewer at the end."""
        pieces, last = [], min(last, self.size)
        for path, end, start in zip(self.paths, self._ends, [0, *self._ends[:-1]], strict=True):
            if first < end and last > start:
                with open_regular(path) as file, foreign_errors(path, "unreadable ({reason})"):
                    file.seek(int(max(first - start, 0)))
                    held = bytearray(int(min(last, end) - max(first, start)))
                    pieces.append(np.frombuffer(held, np.uint8)[: file.readinto(held)])
        return np.concatenate(pieces) if pieces else np.zeros(0, np.uint8)


def part_files(path: Path) -> tuple[Path, ...]:
    """The files of a recording that was split into X_Raw_0.bin, X_Raw_1.bin, ...; any other file stands alone.

    Args:
        path: The file, or any of the parts.

    Returns:
        Files in order.

    Raises:
        InputError: If a part before the last is missing.
    """
    if (found := PART.match(path.name)) is None:
        return (path,)
    numbers = {}
    for one in path.parent.iterdir():
        if (other := PART.match(one.name)) and other[1].lower() == found[1].lower():
            numbers[int(other[2])] = one
    last = max(numbers, default=0)
    if missing := [number for number in range(last) if number not in numbers]:
        raise InputError(
            f"{path} is a part of a recording whose part {found[1]}{missing[0]}{found[3]} is missing; put all parts"
            " into one folder"
        )
    return tuple(numbers[number] for number in range(last + 1))


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Bytes that were sent but are not in the file: `num_bytes` of them from byte `at` of the stream on.

    `unsure` bytes before and after may lie elsewhere; they count as lost.
    """

    at: int
    num_bytes: int
    unsure: int = 0


class BinSamples:
    """Bytes of .bin files without headers; lost are long runs of zeros, and gaps."""

    def __init__(self, paths: tuple[Path, ...], gaps: tuple[Gap, ...] = ()):
        self._files, self.gaps = JoinedFiles(paths), gaps
        self.size = self._files.size + sum(gap.num_bytes for gap in gaps)

    def read(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """As in `SentBytes`; runs of zeros are recognised across the ends of what is read."""
        start, end = max(0, (first - PACKET_BYTES) // 2 * 2), min(self.size, last + PACKET_BYTES)
        data, is_received = self._placed(start, end)
        even = len(data) // 2 * 2
        zeros = np.repeat(_long_runs(data[:even].view("<i2") == 0), 2)
        is_received[:even] &= ~zeros
        return data[first - start : last - start], is_received[first - start : last - start]

    def _placed(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Bytes with gaps filled with zeros, and which are not in a gap."""
        data, is_received = np.zeros(last - first, np.uint8), np.zeros(last - first, bool)
        shift, begin = 0, 0
        for gap in (*self.gaps, Gap(at=self.size, num_bytes=0)):
            low, high = max(first, begin), min(last, gap.at)
            if low < high:
                data[low - first : high - first] = self._files.read(low - shift, high - shift)
                is_received[low - first : high - first] = True
            begin, shift = gap.at + gap.num_bytes, shift + gap.num_bytes
        for gap in self.gaps:
            near = gap.at - gap.unsure - first, gap.at + gap.num_bytes + gap.unsure - first
            is_received[max(near[0], 0) : max(near[1], 0)] = False
        return data, is_received


def _long_runs(is_zero: np.ndarray) -> np.ndarray:
    """Elements within a run of at least MIN_ZEROS true ones."""
    edges = np.diff(np.concatenate([[0], is_zero.view(np.int8), [0]]))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    is_long = ends - starts >= MIN_ZEROS
    marks = np.zeros(len(is_zero) + 1, np.int8)
    marks[starts[is_long]], marks[ends[is_long]] = 1, -1
    return np.cumsum(marks[:-1], dtype=np.int8).astype(bool)
