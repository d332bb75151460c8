"""The data port of TI's demos as logged to a .dat: packets of TLVs after a magic word, little-endian.

Out-of-box demos: TLV 1 contains detected points, x, y, z in m and velocity in m/s as float32 (SDK 3 and later), or
integers with a Q format (SDK 1 and 2); TLV 7 SNR and noise in 0.1 dB; TLV 301 compressed points with their units
(xWRL6432, xWRL1432). The header ends with a sub-frame number, except on the xWR1443. 3D People Tracking: TLV 1020
contains compressed spherical points with their units. Its predecessor, 3D People Counting, has a different header and
TLV lengths that include their own eight bytes; its TLV 6 equals TLV 1020. Truncated packets and packets with
inconsistent lengths are skipped and counted.

Frames are those that the board counted: packets that are missing are frames without points.

Reference: mmWave SDK User Guide, "Output data sent out of the demo"; TI, 3D People Tracking, "UART output data
format"; TI's ROS driver (sub-frame number, SDK 1 and 2); parsers of TI's Industrial Visualizer (TLV 301 and 6).
"""

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes
from mmweaver.io.point_clouds.point_log import LoggedCloud, counted_frames, logged_cloud, point_format

MAGIC = bytes([2, 1, 4, 3, 6, 5, 8, 7])
MAX_BYTES = 2000 * MEGABYTE
HEADER = struct.Struct("<8sIIIIIII")  # magic, version, length, platform, frame, CPU cycles, objects, TLVs
COUNTING_HEADER = struct.Struct("<8sIIIIIIIIIHH")  # ..., frame, sub-frame, margins, times, TLVs, checksum
TLV = struct.Struct("<II")
MAX_PACKET, MAX_TLVS = 1 << 17, 30
MAX_PADDING = 32  # bytes after the last TLV of a packet
COUNTING_2D_HEADER = struct.Struct("<8s10I2H")  # ..., time, length, frame, sub-frame, margins, times, TLVs, checksum
POINTS, SIDE_INFO, COMPRESSED, SPHERICAL, COUNTED = 1, 7, 301, 1020, 6
POINT_KINDS = frozenset((POINTS, COMPRESSED, SPHERICAL))
OUT_OF_BOX = frozenset(range(1, 10))  # TLVs of the out-of-box demos, which omit TLV 1 from a frame without points
MAX_KIND = 2000  # TLV type
WITHOUT_SUB_FRAME = 0x1443  # lower half of the platform
INTEGER_POINT_BYTES = 12


@runtime_checkable
class ByteSource(Protocol):
    """A pipe, serial port or file opened for reading bytes."""

    def read(self, size: int, /) -> bytes:
        """At most `size` bytes; none at the end."""
        ...


@dataclass(frozen=True, kw_only=True)
class UartLog:
    """Points of a log by the board's own frames, and what was skipped."""

    points: LoggedCloud
    frame_number: np.ndarray  # (packet,) counted by the board
    skipped: int  # damaged packets


class Packet(NamedTuple):
    """One packet: frame number, points (point, 6) as in `point_packets`, its end in the data, and types of its TLVs."""

    number: int
    points: np.ndarray
    end: int
    kinds: frozenset[int] = frozenset()


@point_format("ti_uart", ".dat of a TI demo's data port", lambda path, head: MAGIC in head)
def read_uart_points(path: Path) -> LoggedCloud:
    """Points of a log. Raises InputError if it contains no packet."""
    return read_ti_uart(path).points


def read_ti_uart(path: Path | str) -> UartLog:
    """Reads a log of the data port.

    Args:
        path: The file.

    Returns:
        Points, frame numbers, and the number of skipped packets.

    Raises:
        InputError: If it contains no packet, or packets of a demo without a point cloud.
    """
    data = read_bytes(path, max_bytes=MAX_BYTES)
    packets: list[Packet] = []
    skipped, at = 0, data.find(MAGIC)
    while at >= 0:
        packet = _packet(data, at)
        packets += [] if packet is None else [packet]
        skipped += packet is None
        at = data.find(MAGIC, at + 1 if packet is None else packet.end)
    if not packets:
        raise InputError(f"{path} holds no packet of a TI demo's data port; log the port at its data rate, in binary")
    kinds = frozenset().union(*(packet.kinds for packet in packets))
    table = np.concatenate([packet.points for packet in packets])
    if not kinds & POINT_KINDS and kinds - OUT_OF_BOX:
        raise InputError(
            f"{path} holds {len(packets)} packets, but no point cloud: their TLVs are"
            f" {', '.join(map(str, sorted(kinds)))}, of a demo that reports something else"
        )
    number = np.array([packet.number for packet in packets])
    counted = counted_frames(number)
    damaged = (f"{skipped} damaged packets were left out",) if skipped else ()
    cloud = logged_cloud(
        np.repeat(counted.frame, [len(packet.points) for packet in packets]),
        table[:, :3],
        table[:, 3],
        snr_db=table[:, 4],
        intensity=table[:, 5],
        num_frames=counted.num_frames,
        notes=(*counted.notes, *damaged),
        missing=counted.missing,
    )
    return UartLog(points=cloud, frame_number=number, skipped=skipped)


def point_packets(source: ByteSource, head: bytes = b"") -> Iterator[np.ndarray]:
    """Iterates over the packets of a stream as they arrive.

    Args:
        source: The stream.
        head: Bytes that were already read from it. Default: none.

    Yields:
        Points of one packet, (point, 6): x, y, z in m, velocity in m/s, SNR in dB, intensity.

    Raises:
        InputError: If no packet starts within 128 KiB.
    """
    data, any_found = head, False
    read: Callable[[int], bytes] = getattr(source, "read1", source.read)  # available bytes, without blocking for more
    while more := read(MAX_PACKET):
        data += more
        while (at := data.find(MAGIC)) >= 0 and len(data) - at >= HEADER.size:
            length = HEADER.unpack_from(data, at)[2]
            if HEADER.size <= length <= MAX_PACKET and len(data) - at < length:
                break  # incomplete packet
            packet = _packet(data, at)
            any_found |= packet is not None
            data = data[at + 1 if packet is None else packet.end :]
            if packet is not None:
                yield packet.points
        if not any_found and len(data) > MAX_PACKET:
            raise InputError("the stream holds no packet of a TI demo's data port, nor CSV with a header")
        if len(data) > 2 * MAX_PACKET:
            data = data[-MAX_PACKET:]


def _packet(data: bytes, at: int) -> Packet | None:
    """Decodes the packet at an offset; None if it is damaged."""
    if at + HEADER.size > len(data):
        return None
    _, _, length, platform, number, _, objects, tlvs = HEADER.unpack_from(data, at)
    if length > MAX_PACKET:  # the length comes later in the header of the oldest demo
        return _counting_2d(data, at)
    end = at + length
    if not HEADER.size <= length <= MAX_PACKET or end > len(data):
        return None
    sub_frame = 0 if platform & 0xFFFF == WITHOUT_SUB_FRAME else 4
    for header in (HEADER.size + sub_frame, HEADER.size + 4 - sub_frame):
        found = _tlvs(data, at + header, end, tlvs)
        points = None if found is None else _points(found, objects)
        if points is not None:
            return Packet(number, points, end, frozenset(found or ()))
    if at + COUNTING_HEADER.size <= end:
        tlvs = COUNTING_HEADER.unpack_from(data, at)[-2]
        found = _tlvs(data, at + COUNTING_HEADER.size, end, tlvs, own_bytes=TLV.size)
        points = None if found is None else _points({SPHERICAL: found[COUNTED]} if COUNTED in found else {}, 0)
        if points is not None:
            return Packet(
                number, points, end, frozenset(SPHERICAL if kind == COUNTED else kind for kind in found or ())
            )
    return None


def _counting_2d(data: bytes, at: int) -> Packet | None:
    """A packet of 2D People Counting (xWR16xx): TLV 6 has range, azimuth, Doppler and SNR as float32."""
    if at + COUNTING_2D_HEADER.size > len(data):
        return None
    head = COUNTING_2D_HEADER.unpack_from(data, at)
    length, number, tlvs = head[4], head[5], head[-2]
    end = at + length
    if not COUNTING_2D_HEADER.size <= length <= MAX_PACKET or end > len(data):
        return None
    found = _tlvs(data, at + COUNTING_2D_HEADER.size, end, tlvs, own_bytes=TLV.size)
    raw = b"" if found is None else found.get(COUNTED, b"")
    if found is None or len(raw) % 16:
        return None
    range_m, azimuth, velocity, snr = np.frombuffer(raw, "<f4").reshape(-1, 4).astype(float).T
    snr_db = 10 * np.log10(np.maximum(snr, 1e-6))
    place = [range_m * np.sin(azimuth), range_m * np.cos(azimuth), np.zeros(len(range_m))]
    points = np.column_stack([*place, velocity, snr_db, snr])
    return Packet(number, points, end, frozenset(SPHERICAL if kind == COUNTED else kind for kind in found))


def _tlvs(data: bytes, at: int, end: int, count: int, own_bytes: int = 0) -> dict[int, bytes] | None:
    """TLVs between two offsets by type; None if they do not fill it. `own_bytes` is included in each length."""
    found: dict[int, bytes] = {}
    if count > MAX_TLVS:
        return None
    for _ in range(count):
        if at + TLV.size > end:
            return None
        kind, size = TLV.unpack_from(data, at)
        at, size = at + TLV.size, size - own_bytes
        if not 0 < kind <= MAX_KIND or not 0 <= size <= end - at:
            return None
        found[kind] = data[at : at + size]
        at += size
    return found if end - at < MAX_PADDING else None


def _points(found: dict[int, bytes], objects: int) -> np.ndarray | None:
    """Columns x, y, z, velocity, SNR in dB and intensity; None if lengths are inconsistent."""
    if SPHERICAL in found:
        return _spherical(found[SPHERICAL])
    if COMPRESSED in found:
        return _compressed(found[COMPRESSED])
    raw = found.get(POINTS, b"")
    if not raw:
        return np.zeros((0, 6))
    if len(raw) == 16 * objects:
        points = np.frombuffer(raw, "<f4").reshape(-1, 4).astype(float)
        side = found.get(SIDE_INFO, b"")
        has_side = len(side) == 4 * objects
        snr_db = np.frombuffer(side, "<i2").reshape(-1, 2)[:, 0] / 10 if has_side else np.full(objects, np.nan)
        return np.column_stack([points, snr_db, np.full(objects, np.nan)])
    return _integer_points(raw)


def _integer_points(raw: bytes) -> np.ndarray | None:
    """Descriptor (count, Q format), then range bin, Doppler bin, peak, x, y, z as 16-bit integers.

    The velocity is omitted, since only the board's .cfg defines its unit.
    """
    if len(raw) < 4:
        return None
    count, q_format = struct.unpack_from("<HH", raw)
    if len(raw) != 4 + INTEGER_POINT_BYTES * count or q_format > 15:
        return None
    table = np.frombuffer(raw, "<i2", count=6 * count, offset=4).reshape(-1, 6).astype(float)
    peak = table[:, 2] % (1 << 16)
    nothing = np.full(count, np.nan)
    return np.column_stack([table[:, 3:6] / (1 << q_format), nothing, nothing, peak])


def _compressed(raw: bytes) -> np.ndarray | None:
    """Units of position, velocity, SNR, noise, two counts; then int16 x, y, z, Doppler, uint8 SNR, noise per point."""
    if len(raw) < 20 or (len(raw) - 20) % 10:
        return None
    place_unit, velocity_unit, snr_unit, _ = struct.unpack_from("<4f", raw)
    kind = np.dtype([("place", "<i2", 3), ("doppler", "<i2"), ("snr", "u1"), ("noise", "u1")])
    table: Any = np.frombuffer(raw, kind, offset=20)
    return np.column_stack(
        [
            table["place"] * place_unit,
            table["doppler"] * velocity_unit,
            table["snr"] * snr_unit,
            np.full(len(table), np.nan),
        ]
    )


def _spherical(raw: bytes) -> np.ndarray | None:
    """Five units, then per point: int8 elevation and azimuth, int16 Doppler, uint16 range and SNR."""
    if len(raw) < 20 or (len(raw) - 20) % 8:
        return None
    elevation_unit, azimuth_unit, velocity_unit, range_unit, snr_unit = struct.unpack_from("<5f", raw)
    kind = np.dtype([("elevation", "i1"), ("azimuth", "i1"), ("doppler", "<i2"), ("range", "<u2"), ("snr", "<u2")])
    table: Any = np.frombuffer(raw, kind, offset=20)
    elevation, azimuth = table["elevation"] * elevation_unit, table["azimuth"] * azimuth_unit
    range_m, snr = table["range"] * range_unit, table["snr"] * snr_unit
    flat_m = range_m * np.cos(elevation)
    snr_db = 10 * np.log10(np.maximum(snr, 1e-6))
    return np.column_stack(
        [
            flat_m * np.sin(azimuth),
            flat_m * np.cos(azimuth),
            range_m * np.sin(elevation),
            table["doppler"] * velocity_unit,
            snr_db,
            snr,
        ]
    )
