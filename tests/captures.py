"""Capture folders written in the test, in the format of mmwave-capture-std."""

import io
import json
import struct
from pathlib import Path
from typing import Any

import av
import numpy as np
import zstandard

from mmweaver.core.records import AdcCube, CameraIntrinsics
from mmweaver.io.dca1000 import write_bin
from mmweaver.io.ti_cfg import read_ti_cfg

CFG = """% written by a test
sensorStop
flushCfg
dfeDataOutputMode 1
channelCfg 15 5 0
adcCfg 2 1
adcbufCfg -1 0 1 1 1
profileCfg 0 77 429 7 57.14 0 0 70 1 64 5209 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 8 0 100 1 0
lvdsStreamCfg -1 0 1 0
sensorStart
"""
START_S = 1_700_000_000.25
PAYLOAD = 1456
Packet = tuple[float, bytes]


def radar_of_cfg(folder: Path):
    path = folder / "made.cfg"
    path.write_text(CFG)
    return read_ti_cfg(path)


def counts(config, num_frames: int = 3, seed: int = 0) -> AdcCube:
    """Random whole counts, the same for the same seed."""
    rng = np.random.default_rng(seed)
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    samples = rng.integers(-2000, 2000, shape) + 1j * rng.integers(-2000, 2000, shape)
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0)


def packets_of(folder: Path, adc: AdcCube) -> list[Packet]:
    """UDP payloads of a DCA1000 that sends a recording, each with its time; a frame's come at its start."""
    path = folder / "adc.bin"
    write_bin(path, adc, iq_order="qi", counts_per_unit=1.0)
    data = path.read_bytes()
    path.unlink()
    a_frame = len(data) // len(adc.samples)
    packets = []
    for number, first in enumerate(range(0, len(data), PAYLOAD), 1):
        last = min(first + PAYLOAD, len(data)) - 1  # a packet is sent once it is full
        time_s = START_S + (last // a_frame) * adc.config.frame_period_s + 1e-7 * (last % a_frame)
        payload = struct.pack("<IIH", number, first & 0xFFFFFFFF, first >> 32) + data[first : first + PAYLOAD]
        packets.append((time_s, payload))
    return packets


def pcap_of(packets: list[Packet], *, port: int = 4098, magic: bytes = b"\xd4\xc3\xb2\xa1", link: int = 1) -> bytes:
    """A .pcap of UDP packets, as tcpdump writes it."""
    order = "<" if magic[0] in (0xD4, 0x4D) else ">"
    ticks = 1e9 if magic in (b"\x4d\x3c\xb2\xa1", b"\xa1\xb2\x3c\x4d") else 1e6
    parts = [magic, struct.pack(f"{order}HHiIII", 2, 4, 0, 0, 65535, link)]
    for time_s, payload in packets:
        udp = struct.pack(">HHHH", 4098, port, 8 + len(payload), 0) + payload
        address = bytes((192, 168, 33, 180, 192, 168, 33, 30))
        ip = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0) + address + udp
        frame = {1: bytes(12) + b"\x08\x00", 101: b"", 113: bytes(14) + b"\x08\x00"}[link] + ip
        seconds = int(time_s)
        fraction = round((time_s - seconds) * ticks)
        parts.append(struct.pack(f"{order}IIII", seconds, fraction, len(frame), len(frame)) + frame)
    return b"".join(parts)


def avi_of(pictures: list[np.ndarray], *, codec: str = "png") -> bytes:
    """An .avi of RGB pictures; lossless by default."""
    stream = io.BytesIO()
    with av.open(stream, "w", format="avi") as container:
        video = container.add_stream(codec, rate=15)
        video.height, video.width = pictures[0].shape[:2]
        video.pix_fmt = {"png": "rgb24", "mjpeg": "yuvj444p", "mpeg4": "yuv420p"}[codec]
        video.options = {} if codec == "png" else {"qscale": "1", "flags": "+qscale"}
        for picture in pictures:
            container.mux(video.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(video.encode())
    return stream.getvalue()


def write_camera(folder: Path, lens: CameraIntrinsics, depths_m: list[np.ndarray], pictures: list[np.ndarray]) -> None:
    """The RealSense's folder; photos at 15 a second from 20 ms after START_S."""
    folder.mkdir()
    own = {"width": lens.width, "height": lens.height, "fx": lens.fx, "fy": lens.fy, "ppx": lens.cx, "ppy": lens.cy}
    own |= {"model": "brown_conrady", "coeffs": [0.0] * 5}
    wide = {**own, "width": pictures[0].shape[1], "height": pictures[0].shape[0]}
    scale = wide["width"] / lens.width
    wide |= {"fx": lens.fx * scale, "fy": lens.fy * scale}
    wide |= {"ppx": (wide["width"] - 1) / 2, "ppy": (wide["height"] - 1) / 2}
    times = [{"frame_num": i, "timestamp": 5.0, "time_of_arrival": 1e3 * (START_S + 0.02 + i / 15)} for i in range(9)]
    for name, content in (
        ("depth", {"intrinsics": own, "depth_units": 0.001, "fps": 15}),
        ("color", {"intrinsics": wide}),
    ):
        (folder / f"{name}_config.json").write_text(json.dumps(content))
        (folder / f"{name}_metadata.json").write_text(json.dumps(times))
    raw = b"".join(np.nan_to_num(1e3 * depth).round().astype("<u2").tobytes() for depth in depths_m)
    (folder / "depth.zst").write_bytes(zstandard.ZstdCompressor().compress(raw))
    (folder / "color.avi").write_bytes(avi_of(pictures))


def write_radar(folder: Path, adc: AdcCube, packets: list[Packet] | None = None, **options: Any) -> None:
    """The radar's folder."""
    folder.mkdir(parents=True)
    (folder / "radar.cfg").write_text(CFG)
    (folder / "dca.json").write_text("{}")
    (folder / "dca.pcap").write_bytes(pcap_of(packets_of(folder, adc) if packets is None else packets, **options))
