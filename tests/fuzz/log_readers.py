"""Readers of what boards, other projects and users write besides recordings: point clouds, captures of Wireshark,
lists of activities, command files, requests of the studio's page, whole result folders, checkpoints."""

import io
import json
import random
import shutil
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.cli.arguments import parsed
from mmweaver.cli.main import parser_of
from mmweaver.compression.checked_file import CHECK
from mmweaver.compression.lossless_file import PREFIX as LOSSLESS
from mmweaver.compression.lossless_file import LosslessFile, compress_bin
from mmweaver.core.boards import MMMESH, PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_tensors import read_checkpoint
from mmweaver.core.safe_files.safe_text import read_json, read_text
from mmweaver.core.tensor_files import write_tensors
from mmweaver.datasets.build_set import read_activities
from mmweaver.io.dca_packets import read_pcap, udp_packets
from mmweaver.io.peer_arrays import detect_layout, read_cubelearn, read_hupr
from mmweaver.io.point_clouds.read_points import read_points
from mmweaver.io.radar_options import RadarOptions, read_antennas
from mmweaver.io.stored_result import read_result
from mmweaver.io.stream_folder import read_stream_cube
from mmweaver.models.weights import FORMAT, load_into
from mmweaver.motion.language.sentence import parse
from mmweaver.studio.schemas import Form
from mmweaver.training.trainer import RunLog
from mmweaver.viz.body_in_photo import pack, unpack
from tests.fuzz import mutators as m
from tests.fuzz.harness import Reader, wrong_numbers
from tests.fuzz.set_readers import members_reader
from tests.io.point_clouds.test_read_points import XYZV, out_of_box, packet
from tests.io.test_pcap import pcapng_of
from tests.io.test_peer_arrays import hupr_array, simulated_frame

ACTIVITIES = """[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
walking = ["a person walks around"]
squatting = "a person squats"
"""
SENTENCES = (
    "a person walks two metres towards the radar, then waves three times with the left hand for 2 seconds",
    "a tall man sits down on the sofa behind the table, drinks slowly and stands up after 1.5 seconds",
    "someone turns 90 degrees to the left, does five squats, jogs on the spot and falls to the right",
)
REQUEST = """command = "generate"
frames = 20
seed = 3
text = ["a person waves"]
at = ["0.5,2.0"]
radar = "awr1843"
points = "firmware"
no-pictures = true
"""
ANTENNAS = {"tx": [[0, 0], [4, 0], [8, 1]], "rx": [[0, 0], [1, 0], [2, 0], [3, 0]], "rx_inverted": [1]}
ASKED = {"room": "demo", "text": ["a person walks to the left"], "radar": "awr1843", "seed": 1, "at": [0.5, 2.0]}
CARD = {
    "recipe": "fuzz", "licence": "MIT", "dataset_sha256": "", "radar": "awr1843", "steps": 3, "seed": 0,
    "validation_loss": 1.0, "mmweaver_version": "0.2.0",
}  # fmt: skip


def log_readers(folder: Path, config: RadarConfig) -> list[Reader]:
    """All of them, with sound files made in `folder`, which holds recording.bin of the radar."""
    return [*_clouds(), *_captures(folder, config), *_texts(), *_folders(folder), *_tensors(folder), *_arrays()]


def _read(name: str, suffix: str, read: Callable[[Path], Any], sound: list[bytes], **more: Any) -> Reader:
    """A reader of which bytes are damaged, or, of a text, words and lines."""

    def damaged(rng: random.Random) -> bytes:
        data = rng.choice(sound)
        if data.isascii() and rng.random() < 0.7:
            return m.mutated_text(data.decode(), rng).encode("utf-8", "surrogatepass")
        return m.mutated_bytes(data, rng)

    return Reader(name=name, suffix=suffix, read=read, **{"damaged": damaged, **more})


# point clouds -------------------------------------------------------------------------------------------------------
def _clouds() -> list[Reader]:
    units = struct.pack("<5f", 0.01, 0.01, 0.05, 0.002, 0.04)
    tracked = b"".join(struct.pack("<bbhHH", *row) for row in [(10, -20, 8, 1000, 500), (0, 0, -4, 500, 250)])
    target = struct.pack("<I", 5) + struct.pack("<27f", *range(27))
    old = struct.pack("<HH", 1, 9) + np.array([[10, 3, 900, 256, 1024, -128]], "<i2").tobytes()
    logs = [
        out_of_box(7, XYZV) + out_of_box(8, XYZV[:1]),
        packet(4, [(1020, units + tracked), (1010, target)], 2) * 2,
        packet(1, [(1, old)], 1, version=0x01010005) * 2,
    ]
    csv = b"Frame #,# Obj,X,Y,Z,Doppler,Intensity\n926,2,0.3,1.8,0.5,0,13\n926,2,0.4,1.9,0.6,-0.5,18\n928,1,0,2,0,1,7\n"
    csv += b"929,1,0.1,2,0,1,7\n" * 20
    radhar = b"".join(
        b"header: \n  seq: 1\npoint_id: %d\nx: %d\ny: 0.5\nz: -0.1\nrange: 2\nvelocity: -0.3\nintensity: 9\n---\n"
        % (index % 2, 2 + index)
        for index in range(4)
    )
    table = np.column_stack([XYZV, [5.0, 6.0, 7.0]])
    archives = [{"frame": np.array([3, 3, 5]), "pts": table}, {"frame": np.array([0, 1]), "pts": np.ones((2, 8))}]

    npz = {"damaged": lambda rng: m.mutated_npz(rng.choice(archives), rng)}
    rows = [[*map(float, row), 21.5, 30.0, 255] for row in XYZV]
    replay = {"cfg": [], "data": [{"frameData": {"frameNum": 3 + k, "pointCloud": rows[k:]}} for k in range(3)]}
    stack = np.zeros((3, 4, 4, 5), np.float32)
    stack[0, 0, :3] = table
    return [
        _read("points dat", ".dat", read_points, logs, wrong=_wrong_cloud),
        _read("points csv", ".csv", read_points, [csv], wrong=_wrong_cloud),
        _read("points RadHAR", ".txt", read_points, [radhar], wrong=_wrong_cloud),
        _read("points MM-Fi", ".bin", read_points, [table.astype("<f8").tobytes()], wrong=_wrong_cloud),
        _read("points TI replay", ".json", read_points, [json.dumps(replay).encode()], wrong=_wrong_cloud),
        Reader(
            name="points stack",
            suffix=".npy",
            read=lambda path: read_points(path, "arrays"),
            damaged=lambda rng: m.mutated_npy(stack, rng),
            wrong=_wrong_cloud,
        ),
        _read("points mHomeGes", ".npz", read_points, [], wrong=_wrong_cloud, **npz),
    ]


def _wrong_cloud(cloud: Any) -> str | None:
    places = np.stack([cloud.x_m, cloud.y_m, cloud.z_m])
    if not np.isfinite(places).all() or np.isinf(cloud.radial_velocity_mps).any():
        return "places or velocities that are not finite"
    frame = np.asarray(cloud.frame)
    if frame.dtype.kind != "i" or (frame < 0).any() or (np.diff(frame) < 0).any() or frame.max(initial=0) > 1e9:
        return "frame numbers that are impossible"
    return None


# captures -----------------------------------------------------------------------------------------------------------
def _captures(folder: Path, config: RadarConfig) -> list[Reader]:
    from tests import captures

    adc = captures.counts(config, 1)
    packets = captures.packets_of(folder, adc)[:12]
    blocks = [pcapng_of(packets, order=order) for order in "<>"]
    compress_bin(folder / "recording.bin", folder / "recording.mmwl", config)
    lossless = (folder / "recording.mmwl").read_bytes()

    def packed(path: Path) -> Any:
        found = LosslessFile(path)
        return b"".join(found.block(index) for index, count in enumerate(found.block_frames) if count)

    def capture(path: Path) -> Any:
        list(udp_packets(path, 4098))
        return read_pcap(path, config).adc.samples

    return [
        _read("dca.pcapng", ".pcapng", capture, blocks, wrong=wrong_numbers),
        _read("mmwl", ".mmwl", packed, [], damaged=lambda rng: _lossless(lossless, rng)),
    ]


def _lossless(data: bytes, rng: random.Random) -> bytes:
    """A damaged header or block under right checksums, or damaged bytes."""
    if rng.random() < 0.3 or isinstance(rng, m.Undamaged):
        return m.mutated_bytes(data, rng)
    magic, version, size = LOSSLESS.unpack_from(data)
    end = LOSSLESS.size + size
    head, blocks = zlib.decompress(data[LOSSLESS.size : end]), data[end + CHECK.size :]
    if rng.random() < 0.5:
        head = m.json_bytes(m.mutated_json(json.loads(head), rng), rng)
    else:
        front = blocks[:6] if rng.random() < 0.5 else m.mutated_bytes(blocks[:6], rng)[:6].ljust(6, b"\0")
        payload = m.mutated_bytes(blocks[8 : -CHECK.size], rng)
        if rng.random() < 0.7:
            front = struct.pack("<IH", len(payload), struct.unpack("<IH", front)[1])
        body = front + struct.pack("<H", zlib.crc32(front) & 0xFFFF) + payload
        blocks = body + CHECK.pack(zlib.crc32(body))
    body = zlib.compress(head, 9)
    start = LOSSLESS.pack(magic, version, min(len(body), 0xFFFF)) + body
    return start + CHECK.pack(zlib.crc32(start)) + blocks


# texts --------------------------------------------------------------------------------------------------------------
def _texts() -> list[Reader]:
    tables = PRESETS["awr1843"]

    def command(path: Path) -> Any:
        return parsed(*parser_of("generate"), ["generate", "--config", str(path), "--out", "x"])

    def antennas(path: Path) -> Any:
        return RadarOptions(antennas=read_antennas(str(path))).applied(tables).antenna_position_m

    def log(path: Path) -> Any:
        path.parent.joinpath("run").mkdir(exist_ok=True)
        shutil.copy(path, path.parent / "run" / "log.jsonl")
        return RunLog(path.parent / "run", 100)

    def asked(path: Path) -> Any:
        request = Form.of(read_json(path))
        return request.request, request.command(["--demo"]), request.python("sample_room()")

    def of_json(value: Any) -> dict[str, Any]:
        return {"damaged": lambda rng: m.json_bytes(m.mutated_json(value, rng), rng)}

    rows = b"".join(b'{"step": %d, "loss": 0.5, "validation": null}\n' % (50 * index) for index in range(5))
    sound = pack({"title": "walk", "frames": 2}, {"a": np.arange(6, dtype="f4").reshape(2, 3)})
    return [
        _read("sentence", ".txt", lambda path: parse(read_text(path)), [line.encode() for line in SENTENCES]),
        _read("activities.toml", ".toml", read_activities, [ACTIVITIES.encode()]),
        _read("command of --config", ".toml", command, [REQUEST.encode()]),
        _read("antennas.json", ".json", antennas, [], wrong=wrong_numbers, **of_json(ANTENNAS)),
        _read("log of a training", ".jsonl", log, [rows]),
        _read("request of the studio", ".json", asked, [], **of_json(ASKED)),
        _read("sequence for the page", ".wire", lambda path: unpack(path.read_bytes()), [sound]),
    ]


# folders ------------------------------------------------------------------------------------------------------------
def _folders(folder: Path) -> list[Reader]:
    results, parts = folder / "results", folder / "stream"
    shutil.copytree(folder / "summed", results)
    (results / "SHA256SUMS").unlink()
    for first in ("00000000", "00000002"):
        shutil.copytree(results, parts / "parts" / first)
    (parts / "parts.jsonl").write_text("{}\n")

    def result(_: Path) -> Any:
        found = read_result(results)
        return [found.cube.values, found.adc.samples, np.array([len(found.title)])]

    def stream(_: Path) -> Any:
        return [read_stream_cube(parts).values]

    def wrong(arrays: list[np.ndarray]) -> str | None:
        return next((problem for values in arrays if (problem := wrong_numbers(values))), None)

    return [
        members_reader("result folder", results, result, wrong),
        members_reader("stream folder", parts, stream, wrong),
    ]


# tensors ------------------------------------------------------------------------------------------------------------
def _tensors(folder: Path) -> list[Reader]:
    state = torch.nn.Linear(3, 2).state_dict()
    stream = io.BytesIO()
    torch.save({"state_dict": state, "step": 3, "words": ["a"]}, stream)
    checkpoint = stream.getvalue()

    def weights(rng: random.Random) -> bytes:
        tensors = {name: value.clone() for name, value in state.items()}
        card: Any = json.dumps(CARD)
        kind = 3 if isinstance(rng, m.Undamaged) else rng.randrange(4)
        if kind == 0:
            card = m.json_bytes(m.mutated_json(CARD, rng), rng).decode("utf-8", "replace")
        elif kind == 1:
            name = rng.choice(list(tensors))
            tensors[name].view(-1)[0] = rng.choice((float("nan"), float("inf"), 1e30))
        elif kind == 2:
            tensors[rng.choice(("weight", "bias", "x"))] = torch.zeros(rng.choice(((0,), (2, 3), (5,), (1, 2, 3))))
        file = folder / "sound.safetensors"
        write_tensors(file, tensors, {"format": FORMAT, "format_version": "1", "card": card})
        return m.mutated_bytes(file.read_bytes(), rng) if kind == 3 else file.read_bytes()

    def loaded(path: Path) -> Any:
        network = torch.nn.Linear(3, 2)
        load_into(network, path, recipe="fuzz")
        return network.weight.detach().numpy()

    def saved(path: Path) -> Any:
        return read_checkpoint(path, what="no checkpoint ({reason}); train anew")

    return [
        _read("weights", ".safetensors", loaded, [], damaged=weights, wrong=wrong_numbers),
        _read("checkpoint", ".pt", saved, [checkpoint]),
    ]


# arrays of other projects -------------------------------------------------------------------------------------------
def _arrays() -> list[Reader]:
    rng = np.random.default_rng(6)
    radar = PRESETS["hupr"]
    hupr = hupr_array(simulated_frame()).astype("c8")
    cubelearn = rng.integers(-99, 99, (2, 1, 128, 12, 256)).astype("i2")

    def other(path: Path) -> Any:
        layout = detect_layout(path)
        return read_cubelearn(path, MMMESH).samples if layout == "cubelearn" else read_hupr(path, radar).values

    return [
        _read("arrays of others", ".npy", other, [], wrong=wrong_numbers,
              damaged=lambda rng: m.mutated_npy(rng.choice((hupr, cubelearn)), rng))
    ]  # fmt: skip
