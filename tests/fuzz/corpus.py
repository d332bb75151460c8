"""Minimised inputs that once ended in a traceback, a hang or gigabytes, as (reader, what, bytes)."""

import io
import json
import struct
import zipfile
import zlib

import numpy as np
from PIL import Image

from mmweaver.compression.chunk import PREFIX
from mmweaver.compression.mmw_codec import compress_cube
from mmweaver.core.boards import PRESETS
from tests import captures
from tests.cubes import point_cube
from tests.fuzz import mutators as m
from tests.fuzz.set_readers import BOMB, GOLDEN, archive_of, summed

RADAR = json.loads(PRESETS["awr1843"].to_json())
CUT_HEADER = m.lying_npy("{'descr': '<f8', 'fortran_order': False, 'shape': (48, 64", bytes(24576))


def corpus() -> list[tuple[str, str, bytes]]:
    """All of them."""
    return [*_radars(), *_arrays(), *_motions(), *_logs(), *_pictures(), *_containers(), *_sets()]


def _radars() -> list[tuple[str, str, bytes]]:
    nan, inf = float("nan"), float("inf")
    changes = {
        "antenna at NaN": {"tx_position_m": [[nan, 0, 0]], "tx_order": [0]},
        "antenna at infinity": {"rx_position_m": [[inf, 0, 0], [0, 0, 0]]},
        "antennas 1e30 m apart": {"rx_position_m": [[0, 0, 0], [1e30, 0, 0]]},
        "noise figure 5000 dB": {"noise_figure_db": 5000.0}, "noise figure 1e308 dB": {"noise_figure_db": 1e308},
        "full scale 1e-300 V": {"adc_full_scale_v": 1e-300}, "full scale 1e300 V": {"adc_full_scale_v": 1e300},
        "beamwidth 1e-300 degrees": {"azimuth_beamwidth_deg": 1e-300}, "power -1e308 dBm": {"tx_power_dbm": -1e308},
        "receiver gain 1e4 dB": {"rx_gain_db": 1e4}, "limits NaN": {"frequency_limits_hz": [nan, nan]},
        "name of 100,000 characters": {"name": "x" * 100_000}, "name with control characters": {"name": "a\n\x1b[31m"},
    }  # fmt: skip
    long = json.dumps(RADAR).replace(str(RADAR["start_frequency_hz"]), "1" + "0" * 400)
    return [
        *(("radar.json", what, json.dumps({**RADAR, **change}).encode()) for what, change in changes.items()),
        ("radar.json", "start frequency 10**400", long.encode()),
        ("radar.json", "100,000 brackets", b"[" * 100_000),
        ("radar.json", "5,000 digits", b"1" * 5000),
        ("TI cfg", "slope 1e-320", captures.CFG.replace(" 70 1 64 5209", " 1e-320 1 64 5209").encode()),
        ("request.toml", "brackets", b"a = " + b"[" * 5000),
    ]


def _arrays() -> list[tuple[str, str, bytes]]:
    deflated = bytearray(m.npz_bytes({"cube": m.npy_bytes(np.arange(1000.0))}, zipfile.ZIP_DEFLATED))
    at = deflated.find(b"cube.npy") + 28
    deflated[at : at + 8] = b"\xff" * 8
    method, secret = (bytearray(m.npz_bytes({"cube": m.npy_bytes(np.zeros(10))})) for _ in range(2))
    directory = method.find(b"PK\1\2")
    method[directory + 10], secret[directory + 8] = 99, secret[directory + 8] | 1
    bomb = m.npz_bytes({"cube": m.npy_bytes(np.zeros(10_000_000))}, zipfile.ZIP_DEFLATED)
    far = np.full((48, 64), 2.0)
    far[::3] = 1e5
    huge = np.full((48, 64), 2.0)
    huge.reshape(-1)[::5] = 1e30
    archives = {"cut header": m.npz_bytes({"cube": CUT_HEADER}), "damaged deflate": bytes(deflated),
                "method 99": bytes(method), "encrypted": bytes(secret), "80 MB from 80 kB": bomb}  # fmt: skip
    return [
        *((name, what, data) for name in ("radar.npz", "motion npz", "pose.npz") for what, data in archives.items()),
        *((name, "cut header", CUT_HEADER) for name in ("depth npy", "samples npy", "motion npy")),
        ("depth npy", "a third at 1e5 m", m.npy_bytes(far)),
        ("depth npy", "a fifth at 1e30 m", m.npy_bytes(huge)),
        ("samples npy", "1e300", m.npy_bytes(np.full((3, 8, 2, 4, 64), 1e300, np.complex128))),
    ]


def _motions() -> list[tuple[str, str, bytes]]:
    """Of the first run of a seed nobody had used."""
    joints = np.zeros((3, 22, 3))
    names = np.array([f"joint_{k}" for k in range(22)])
    names.view(np.uint32)[3] = 0x7FFFFFFF
    smpl = {"poses": np.zeros((3, 66)), "trans": np.zeros((3, 3))}
    archives = {
        "names beyond Unicode": {"joints_m": joints, "joint_names": names},
        "places that are texts": {"joints_m": joints.astype("S3"), "joint_names": np.array(["a"] * 22)},
        "complex frame rate": {**smpl, "mocap_framerate": np.array(60j)},
        "poses that are texts": {**smpl, "poses": np.full((3, 66), "x")},
    }
    return [
        ("motion npz", what, m.npz_bytes({name: m.npy_bytes(values) for name, values in arrays.items()}))
        for what, arrays in archives.items()
    ]


def _logs() -> list[tuple[str, str, bytes]]:
    """Of the first run over logs and texts."""
    csv = "Frame,X,Y,Z,Doppler\n"
    text = "point_id: 0\nx: 1\ny: 0\nz: 0\nvelocity: {}\n"
    columns = {"frame": m.npy_bytes(np.array([1e300])), "pts": m.npy_bytes(np.zeros((1, 5)))}
    digits = "9" * 400
    return [
        *(
            ("result folder", what, archive_of({"meta.json": json.dumps(meta).encode()}))
            for what, meta in {
                "samples that are described by a text": {"adc_data_bin": "iq"},
                "an order of transmitters that is a number": {"adc_data_bin": {"tx_order": 1}},
                "an order of I and Q that is a list": {"adc_data_bin": {"iq_order": ["iq"]}},
                "a sentence that is a number": {"text": 1.5},
            }.items()
        ),
        ("arrays of others", "NaN in CubeLearn's", m.npy_bytes(np.full((2, 1, 128, 12, 256), np.nan, np.float16))),
        ("points csv", "a field of 200,000 characters", (csv + "1,0,1,0," + "7" * 200_000).encode()),
        ("points csv", "frame 1e300", (csv + "1e300,0,1,0,0\n").encode()),
        ("points RadHAR", "infinite velocity", text.format("inf").encode()),
        ("points mHomeGes", "frame 1e300", m.npz_bytes(columns)),
        ("sentence", "400 digits", f"a person waves {digits} times".encode()),
        ("sentence", "400 digits of metres", f"a person stands {digits} metres away and waves".encode()),
        ("activities.toml", "400 digits", f'[activities]\na = "a person waves {digits} times"\nb = "waves"'.encode()),
    ]


def _pictures() -> list[tuple[str, str, bytes]]:
    stream = io.BytesIO()
    Image.new("RGB", (64, 48)).save(stream, "EPS")
    header = struct.pack(">IIBBBBB", 60_000, 60_000, 8, 2, 0, 0, 0)
    chunk = b"IHDR" + header
    png = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return [("colour picture", "EPS", stream.getvalue()), ("colour picture", "60,000 pixels a side", png)]


def _containers() -> list[tuple[str, str, bytes]]:
    head = {"chunks": [[10**9, 4]], "frame_start_s": 0, "frame_period_s": 0.1, "radar": {"preset": "awr1843"}}
    wide = {**RADAR, "tx_position_m": [[i * 1e-3, 0, 0] for i in range(250)], "tx_order": list(range(250)),
            "frame_period_s": 100.0, "name": "wide", "num_loops": 100, "num_samples": 256}  # fmt: skip
    one = {"chunks": [[1, 4]], "frame_time_s": [0], "radar": {"preset": "awr1843"}}
    far = captures.pcap_of([(captures.START_S, struct.pack("<IIH", 1, 10**9, 0) + bytes(1456))])
    return [
        ("mmw", "many frames in 44 bytes", m.mmw_bytes(head, [(65535, 0, b"abcd")])),
        ("mmw", "1,000 antennas", m.mmw_bytes({**one, "radar": wide, "chunks": [[200, 4]]}, [(1, 0, b"abcd")])),
        ("mmw", "scale 10**400", m.mmw_bytes({**one, "scale": 10**400}, [(1, 0, b"abcd")])),
        ("mmw", "frame time 10**400", m.mmw_bytes({**one, "frame_time_s": [10**400]}, [(1, 0, b"abcd")])),
        ("mmw", "no chunks", m.mmw_bytes({**one, "chunks": [], "frame_time_s": []}, [])),
        ("mmw", "record of an unknown kind at the end", m.mmw_bytes(one, []) + bytes.fromhex("00000000010009")),
        ("mmw", "steps of 3e38", _with_large_steps()),
        ("mmw", "preset is a list", m.mmw_bytes({**one, "radar": {"preset": ["x"]}}, [(1, 0, b"abcd")])),
        ("dca.pcap", "one packet at byte 1e9", far),
        ("safetensors", "header of 2**60 bytes", struct.pack("<Q", 2**60) + b"{}"),
    ]


def _with_large_steps() -> bytes:
    """A sound .mmw file whose chunk multiplies everything by 3e38."""
    cube = point_cube(num_frames=2)
    head, records = m.mmw_parts(compress_cube(cube, num_bytes=2000))
    frames, kind, payload = records[0]
    prefix = list(PREFIX.unpack_from(payload))
    prefix[3] = 3e38
    return m.mmw_bytes(head, [(frames, kind, PREFIX.pack(*prefix) + payload[PREFIX.size :]), *records[1:]])


def _sets() -> list[tuple[str, str, bytes]]:
    name = "office_000/seed/zarr.json"
    with zipfile.ZipFile(GOLDEN) as archive:
        metadata = json.loads(archive.read(f"dataset/{name}"))
    grid = {"name": "regular", "configuration": {"chunk_shape": [2**40]}}
    pickles = [{"name": "bytes"}, {"name": "numcodecs.pickle"}]
    changes = {
        "a terabyte in one chunk": {"shape": [2**40], "chunk_grid": grid}, "a terabyte of chunks": {"shape": [2**40]},
        "pickles": {"codecs": pickles}, "a million chunks": {"shape": [10**6]}, "no shape": {"shape": None},
    }  # fmt: skip
    cases = {what: {name: json.dumps({**metadata, **change}).encode()} for what, change in changes.items()}
    cases["50 MB from 2 kB"] = {name.replace("zarr.json", "c/0"): summed(BOMB)}
    flat = {"intrinsic/intrinsic_color.txt": b"100 0 31 0\n0 0 23 0\n0 0 1 0\n0 0 0 1\n"}
    scans = [("scan of ScanNet", "focal length 0", archive_of(flat))]
    return [*scans, *(("zarr set", what, archive_of(members)) for what, members in cases.items())]
