"""Every reader of mmWeaver with sound files, ways to damage them, and what a result must be."""

import io
import json
import random
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mmweaver.cli.batch import read_texts
from mmweaver.compression.mmw_codec import compress_cube, describe_mmw, read_cube
from mmweaver.core.boards import PRESETS
from mmweaver.core.records import AdcCube, CameraIntrinsics, PointCloud, PoseSequence
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.datasets.tensor_layouts import rf_genesis_settings
from mmweaver.io.dca1000 import read_bin, write_bin
from mmweaver.io.dca_packets import read_pcap
from mmweaver.io.mapped_arrays import ArrayMapping, read_mapped
from mmweaver.io.npz_files import (
    read_points_npz,
    read_poses_npz,
    read_radar_npz,
    write_points_npz,
    write_pose_npz,
    write_radar_npz,
)
from mmweaver.io.radar_file import describe_radar, load_firmware, load_radar
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.recordings.processing import process_recording
from mmweaver.recordings.read_recording import read_recording
from mmweaver.scene.photo.camera_file import intrinsics_for, read_camera_file
from mmweaver.scene.photo.capture_photo import read_capture_photo
from mmweaver.scene.photo.picture_files import read_depth, read_rgb
from mmweaver.scene.segmentation.class_file import read_class_file
from tests import captures
from tests.fuzz import mutators as m
from tests.fuzz.folder_readers import folder_readers
from tests.fuzz.harness import Reader, wrong_numbers
from tests.fuzz.log_readers import log_readers
from tests.fuzz.mesh_readers import mesh_readers
from tests.fuzz.set_readers import set_readers
from tests.io.test_infineon import CHIRP
from tests.io.test_mmwave_studio import SETUP
from tests.motion.mocap.test_c3d import markers, write_c3d

WIDTH, HEIGHT = 64, 48
STUDIO = {"mmWaveDevices": [{"rfConfig": SETUP, "rawDataCaptureConfig": {"rlDevDataFmtCfg_t": {"iqSwapSel": 0}}}]}
FIRMWARE = (
    "cfarCfg -1 0 2 8 4 3 0 15 1\ncfarCfg -1 1 0 4 2 3 1 15 1\npeakGrouping -1 1 1 1 1 229\nclutterRemoval -1 0\n"
    "multiObjBeamForming -1 1 0.5\n"
)
CAMERA = {"fx": 50.0, "fy": 50.0, "cx": 31.5, "cy": 23.5, "width": WIDTH, "height": HEIGHT, "depth_unit_m": 0.001}


def make_readers(folder: Path) -> list[Reader]:
    """All readers, with sound files made in `folder`."""
    config = captures.radar_of_cfg(folder)
    adc = captures.counts(config)
    return [
        *_radars(),
        *_pictures(folder),
        *_recordings(folder, config, adc),
        *_results(folder, config, adc),
        *_others(folder),
        *set_readers(folder),
        *log_readers(folder, config),
        *folder_readers(folder),
        *mesh_readers(folder),
    ]


# radars -------------------------------------------------------------------------------------------------------------
def _radars() -> list[Reader]:
    presets = [json.loads(config.to_json()) for config in PRESETS.values()]
    cfg = captures.CFG + FIRMWARE

    def studio(path: Path) -> Any:
        return load_radar(str(path))

    def ti(path: Path) -> Any:
        load_firmware(str(path))
        return load_radar(str(path))

    genesis = rf_genesis_settings(PRESETS["mmmesh"])

    return [
        Reader(
            "radar.json",
            ".json",
            lambda rng: _json_of(rng.choice(presets), rng),
            lambda path: load_radar(str(path)),
            _wrong_radar,
        ),
        Reader("TI cfg", ".cfg", lambda rng: _text_of(cfg, rng), ti, _wrong_radar),
        Reader(
            "Infineon config",
            ".json",
            lambda rng: _json_of({"device_config": {"fmcw_single_shape": CHIRP}}, rng),
            studio,
            _wrong_radar,
        ),
        Reader("RF-Genesis config", ".json", lambda rng: _json_of(genesis, rng), studio, _wrong_radar),
        Reader("mmWave Studio json", ".mmwave.json", lambda rng: _json_of(STUDIO, rng), studio, _wrong_radar),
    ]


def _wrong_radar(config: Any) -> str | None:
    describe_radar(config)
    numbers = [config.range_resolution_m, config.velocity_resolution_mps, config.wavelength_m, config.noise_power_mw]
    if not np.isfinite([*numbers, *config.antenna_position_m.ravel(), *config.range_m]).all():
        return "a radar that is not finite"
    return (
        "a radar that fills the memory" if config.num_loops * config.num_antennas * config.num_samples > 2**25 else None
    )


# pictures -----------------------------------------------------------------------------------------------------------
def _pictures(folder: Path) -> list[Reader]:
    rng = np.random.default_rng(0)
    colours = Image.fromarray(rng.integers(0, 255, (HEIGHT, WIDTH, 3), dtype=np.uint8))
    exif = Image.Exif()
    exif[0x0112] = 6
    rgb = [
        *(
            _encoded(colours, kind)
            for kind in ("PNG", "JPEG", "TIFF", "WEBP", "BMP", "PPM", "GIF", "EPS", "DDS", "TGA")
        ),
        *(_encoded(colours.convert(mode), "PNG") for mode in ("P", "RGBA", "LA", "1", "L")),
        _encoded(colours, "JPEG", exif=exif),
        _encoded(colours.convert("CMYK"), "JPEG"),
        _encoded(colours, "TIFF", compression="tiff_lzw"),
        _encoded(colours, "TIFF", compression="tiff_adobe_deflate"),
    ]
    metres = rng.uniform(0.5, 4, (HEIGHT, WIDTH))
    counts = Image.fromarray((1000 * metres).astype(np.uint16))
    floats = Image.fromarray(metres.astype(np.float32))
    depth = [
        _encoded(counts, "PNG"),
        _encoded(counts, "TIFF"),
        _encoded(floats, "TIFF"),
        _encoded(floats, "TIFF", compression="tiff_adobe_deflate"),
        _encoded(Image.fromarray((1000 * metres).astype(np.int32)), "TIFF"),
    ]
    classes = _encoded(Image.fromarray(rng.integers(0, 5, (HEIGHT, WIDTH)).astype(np.uint8)), "PNG")
    names = {"0": "unlabeled", "1": "couch", "2": "wall-brick", "3": "bed", "4": "floor"}
    arrays = [
        metres,
        metres.astype("f4"),
        (1000 * metres).astype("u2"),
        (1000 * metres).astype(">i4"),
        metres.astype("f2"),
    ]

    def mask(path: Path) -> Any:
        path.with_suffix(".png").write_bytes(classes)
        return read_class_file(path.with_suffix(".png"), WIDTH, HEIGHT)

    def camera(path: Path) -> Any:
        return intrinsics_for(path, read_camera_file(path), 640, 480)

    return [
        Reader(
            "colour picture",
            ".png",
            lambda rng: _picture_of(rng.choice(rgb), rng),
            lambda path: read_rgb(path)[0],
            lambda a: None if a.dtype == np.uint8 and a.ndim == 3 and a.size else f"colours {a.dtype} {a.shape}",
        ),
        Reader(
            "depth picture",
            ".png",
            lambda rng: _picture_of(rng.choice(depth), rng),
            lambda path: read_depth(path, None)[0],
            _wrong_depth,
        ),
        Reader(
            "depth npy",
            ".npy",
            lambda rng: m.mutated_npy(rng.choice(arrays), rng),
            lambda path: read_depth(path, None)[0],
            _wrong_depth,
        ),
        Reader(
            "class mask",
            ".png",
            lambda rng: _picture_of(classes, rng),
            lambda path: read_class_file(path, WIDTH, HEIGHT),
        ),
        Reader("class names", ".json", lambda rng: _json_of(names, rng), mask),
        Reader(
            "camera.json",
            ".camera.json",
            lambda rng: _json_of(CAMERA, rng),
            camera,
            lambda c: None if np.isfinite([c.fx, c.fy, c.cx, c.cy]).all() else "a camera that is not finite",
        ),
    ]


def _wrong_depth(depth: np.ndarray) -> str | None:
    held = depth[np.isfinite(depth)]
    if not held.size or held.size < 0.09 * depth.size:
        return "depth with nothing but holes"
    return None if held.min() >= 0.01 and held.max() <= 100 else f"depth from {held.min():g} to {held.max():g} m"


def _encoded(image: Image.Image, kind: str, **options: Any) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **options)
    return stream.getvalue()


# recordings ---------------------------------------------------------------------------------------------------------
def _recordings(folder: Path, config: Any, adc: AdcCube) -> list[Reader]:
    write_bin(folder / "recording.bin", adc, counts_per_unit=1.0)
    raw = (folder / "recording.bin").read_bytes()
    packets = captures.packets_of(folder, adc)
    samples = adc.samples[:1].transpose(0, 1, 2, 3, 4)
    axes = "frame,loop,tx,rx,sample"
    headed = b"".join(payload for _, payload in packets)
    mapping = ArrayMapping(path=folder / "map.toml", axes=axes)

    def pcap(rng: random.Random) -> bytes:
        if rng.random() < 0.5 or isinstance(rng, m.Undamaged):
            return m.mutated_bytes(captures.pcap_of(packets[:40]), rng)
        damaged = list(packets[:40])
        for _ in range(rng.choice((1, 1, 3))):
            at = rng.randrange(len(damaged))
            time_s, payload = damaged[at]
            kind = rng.randrange(5)
            if kind == 0:
                del damaged[at]
            elif kind == 1:
                damaged.insert(rng.randrange(len(damaged)), (time_s, payload))
            elif kind == 2:
                damaged[at] = (time_s, payload[: rng.randrange(len(payload))])
            elif kind == 3:
                head = rng.choice((b"\xff" * 10, bytes(10), b"\1\0\0\0\0\xca\x9a\x3b\0\0", rng.randbytes(10)))
                damaged[at] = (time_s, head + payload[10:])
            else:
                damaged[at] = (rng.choice((0.0, 4e9)), payload)
            damaged = damaged or [(0.0, b"")]
        return captures.pcap_of(damaged)

    return [
        Reader(
            "adc_data.bin",
            ".bin",
            lambda rng: m.mutated_bytes(raw, rng),
            lambda path: read_bin(path, config).samples,
            wrong_numbers,
        ),
        Reader(
            "packets with headers",
            ".bin",
            lambda rng: m.mutated_bytes(headed, rng),
            lambda path: read_recording(path, config).cube.values,
            wrong_numbers,
        ),
        Reader(
            "mapped npy",
            ".npy",
            lambda rng: m.mutated_npy(samples, rng),
            lambda path: read_mapped(path, mapping, config).samples,
            wrong_numbers,
        ),
        Reader(
            "samples npy",
            ".npy",
            lambda rng: m.mutated_npy(samples, rng),
            lambda path: read_adc_npy(path, config, axes).samples,
            wrong_numbers,
        ),
        Reader("dca.pcap", ".pcap", pcap, lambda path: read_pcap(path, config).adc.samples, wrong_numbers),
        _capture(folder),
    ]


def _capture(folder: Path) -> Reader:
    rng = np.random.default_rng(1)
    place = folder / "capture" / "realsense"
    place.parent.mkdir()
    lens = CameraIntrinsics(fx=50.0, fy=50.0, cx=31.5, cy=23.5, width=WIDTH, height=HEIGHT)
    pictures = [rng.integers(0, 255, (HEIGHT, WIDTH, 3), dtype=np.uint8) for _ in range(2)]
    captures.write_camera(place, lens, [rng.uniform(1, 3, (HEIGHT, WIDTH)) for _ in range(2)], pictures)
    sound = {file.name: file.read_bytes() for file in place.iterdir()}
    names = sorted(sound)

    def damaged(rng: random.Random) -> bytes:
        name = rng.choice(names)
        data = sound[name]
        new = _json_of(json.loads(data), rng) if name.endswith(".json") else m.mutated_bytes(data, rng)
        return name.encode() + b"\n" + new

    def read(path: Path) -> Any:
        name, _, data = path.read_bytes().partition(b"\n")
        (place / name.decode()).write_bytes(data)
        try:
            return read_capture_photo(place.parent, 1).photo.depth_m
        finally:
            (place / name.decode()).write_bytes(sound[name.decode()])

    return Reader("capture folder", ".member", damaged, read)


# results ------------------------------------------------------------------------------------------------------------
def _results(folder: Path, config: Any, adc: AdcCube) -> list[Reader]:
    cube = process_recording(folder / "recording.bin", config).cube
    (folder / "radar.json").write_text(config.to_json())
    rng = np.random.default_rng(2)
    pose = PoseSequence(
        time_s=np.arange(5) / 10, joints_m=rng.normal(size=(5, 22, 3)).astype(np.float32), height_m=1.7, subject=0
    )
    columns = {
        name: rng.normal(size=4).astype(np.float32) for name in ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    }
    write_radar_npz(folder / "radar.npz", cube)
    write_pose_npz(folder / "pose.npz", pose)
    write_points_npz(folder / "points.npz", PointCloud(frame=np.arange(4), **columns))
    held = {name: dict(np.load(folder / f"{name}.npz")) for name in ("radar", "pose", "points")}
    mmw = [compress_cube(cube, num_bytes=3000)]

    def radar(path: Path) -> Any:
        return read_radar_npz(path, config).values

    def described(path: Path) -> Any:
        describe_mmw(path)
        return read_cube(path).values

    return [
        Reader("radar.npz", ".npz", lambda rng: m.mutated_npz(held["radar"], rng), radar, wrong_numbers),
        Reader("pose.npz", ".npz", lambda rng: m.mutated_npz(held["pose"], rng), read_poses_npz, _wrong_poses),
        Reader("points.npz", ".npz", lambda rng: m.mutated_npz(held["points"], rng), read_points_npz, _wrong_points),
        Reader("mmw", ".mmw", lambda rng: m.mutated_mmw(rng.choice(mmw), rng), described, wrong_numbers),
    ]


def _wrong_poses(poses: Any) -> str | None:
    for pose in poses:
        if (
            len(pose.time_s) != len(pose.joints_m)
            or not np.isfinite(pose.joints_m).all()
            or not np.isfinite(pose.time_s).all()
        ):
            return "a pose whose times do not fit, or that is not finite"
    return None


def _wrong_points(cloud: Any) -> str | None:
    columns = (cloud.frame, cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps, cloud.snr_db)
    return None if len({np.shape(column) for column in columns}) == 1 else "columns of unequal length"


# the rest -----------------------------------------------------------------------------------------------------------
def _others(folder: Path) -> list[Reader]:
    import torch

    rng = np.random.default_rng(3)
    rest = np.cumsum(rng.normal(0, 0.02, (12, 1, 3)), axis=0) + _standing()
    amass = {
        "poses": rng.normal(0, 0.2, (12, 156)),
        "trans": np.cumsum(rng.normal(0, 0.01, (12, 3)), axis=0),
        "betas": np.zeros(10),
        "mocap_framerate": np.array(60.0),
    }
    joints = {"joints_m": rest, "joint_names": np.array(JOINT_NAMES), "frame_time_s": np.arange(12) / 20}
    write_tensors(folder / "t.safetensors", {"a": torch.arange(12.0).reshape(3, 4), "b": torch.ones(5)}, {"card": "{}"})
    tensors = (folder / "t.safetensors").read_bytes()
    bvh = _bvh()
    write_c3d(folder / "walk.c3d", markers())
    c3d = (folder / "walk.c3d").read_bytes()
    toml = 'frames = 20\nseed = 3\ntext = ["a person waves"]\nat = [0.5, 2.0]\nradar = "awr1843"\n'

    def motion(fps: float | None) -> Callable[[Path], Any]:
        return lambda path: read_motion(path, fps=fps).joints_m

    return [
        Reader("motion c3d", ".c3d", lambda rng: m.mutated_bytes(c3d, rng), motion(None), wrong_numbers),
        Reader("motion npy", ".npy", lambda rng: m.mutated_npy(rest, rng), motion(20.0), wrong_numbers),
        Reader(
            "motion npz",
            ".npz",
            lambda rng: m.mutated_npz(rng.choice((amass, joints)), rng),
            motion(None),
            wrong_numbers,
        ),
        Reader("motion bvh", ".bvh", lambda rng: _text_of(bvh, rng), motion(None), wrong_numbers),
        Reader("safetensors", ".safetensors", lambda rng: m.mutated_bytes(tensors, rng), read_tensors),
        Reader("request.toml", ".toml", lambda rng: _text_of(toml, rng), read_toml),
        Reader("texts", ".txt", lambda rng: _text_of("a person waves\n# no\nwalks\n", rng), read_texts),
    ]


def _standing() -> np.ndarray:
    from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward

    joints = forward(np.zeros((1, 22, 3)), np.zeros((1, 3)), MEAN_OFFSET_M)[0]
    return joints[:, [2, 0, 1]] + np.array([0.0, 0.0, 1.0])


def _bvh() -> str:
    """A skeleton of SMPL's joints in centimetres, y up, and three frames."""
    from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M

    def joint(index: int) -> str:
        x, y, z = 100 * MEAN_OFFSET_M[index]
        below = "".join(joint(child) for child, parent in enumerate(PARENTS) if parent == index)
        end = "End Site\n{\nOFFSET 0 5 0\n}\n"
        kind = "ROOT" if PARENTS[index] < 0 else "JOINT"
        places = "6 Xposition Yposition Zposition" if PARENTS[index] < 0 else "3"
        return (
            f"{kind} {JOINT_NAMES[index]}\n{{\nOFFSET {x:.3f} {y:.3f} {z:.3f}\nCHANNELS {places} Zrotation Xrotation"
            f" Yrotation\n{below or end}}}\n"
        )

    frames = "".join(f"{step} 95 0 " + "1 2 3 " * len(PARENTS) + "\n" for step in range(3))
    return f"HIERARCHY\n{joint(0)}MOTION\nFrames: 3\nFrame Time: 0.0333\n{frames}"


def _json_of(value: Any, rng: random.Random) -> bytes:
    data = m.json_bytes(m.mutated_json(value, rng), rng)
    return m.mutated_bytes(data, rng) if rng.random() < 0.3 else data


def _text_of(text: str, rng: random.Random) -> bytes:
    data = m.mutated_text(text, rng).encode("utf-8", "surrogatepass")
    return m.mutated_bytes(data, rng) if rng.random() < 0.3 else data


def _picture_of(data: bytes, rng: random.Random) -> bytes:
    damaged = m.mutated_bytes(data, rng)
    return m.png_with_right_checksums(damaged) if data.startswith(b"\x89PNG") and rng.random() < 0.7 else damaged


def fuzz_folder() -> tempfile.TemporaryDirectory[str]:
    """A folder for the files of a run, in memory where the system has such a place."""
    shared = Path("/dev/shm")
    return tempfile.TemporaryDirectory(dir=shared if shared.is_dir() else None)
