"""Raw samples without loss: bytes and CPU seconds of .mmwl and of general, audio and picture compressors.

python -m studies run lossless_codecs --data <recordings>        (extra `codecs`; the tools flac, wavpack, xz, zstd)
"""

import argparse
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import lfilter

from mmweaver.compression.lossless_file import LosslessFile, compress_bin
from mmweaver.core.radar_config import RadarConfig
from mmweaver.io.mmwave_studio import read_mmwave_studio
from studies.baselines.codec_interface import library
from studies.fields.field_signals import two_people_radar
from studies.manifest import StudyRun, content_of
from studies.result_rows import complete_rows
from studies.study import Reads

EXPERIMENT = "lossless_codecs"
LMS_TAPS, LMS_SHIFT = 16, 9
CHANNELS = (1, 2, 4, 8)  # audio compressors take the words as so many channels; the smallest file counts

Compress = Callable[[Path, Path, RadarConfig], int]


def office(data: Path, folder: Path) -> tuple[Path, RadarConfig]:
    """One frame of a DCA1000, as it was recorded."""
    source = data / "radar" / "iwr6843_dca1000"
    path = folder / "office.bin"
    shutil.copyfile(source / "adc_data_example.bin", path)
    return path, read_mmwave_studio(source / "mmwaveDevice.mmwave.json")


def two_people(data: Path, folder: Path) -> tuple[Path, RadarConfig]:
    """The recorded two people, back in the order of a DCA1000 file: (chirp, receiver, sample pairs, I and Q)."""
    samples = np.load(data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy")
    pairs = samples.reshape(-1, samples.shape[-1] // 2, 2)
    words = np.stack([pairs.real, pairs.imag], axis=2)
    assert np.array_equal(words, np.rint(words))
    path = folder / "two_people.bin"
    path.write_bytes(words.astype("<i2").tobytes())
    return path, replace(two_people_radar(num_loops=128), first_range_bin=0, num_range_bins=128)


def ours(path: Path, folder: Path, config: RadarConfig) -> int:
    """Bytes of the .mmwl file, decoded and compared."""
    size = compress_bin(path, folder / "a.mmwl", config)
    LosslessFile(folder / "a.mmwl").decompress(folder / "again.bin")
    assert (folder / "again.bin").read_bytes() == path.read_bytes()
    return size


def by_tool(*command: str) -> Compress:
    """Bytes that a command writes to its standard output."""
    return lambda path, _folder, _config: len(_output([*command, str(path)]))


def flac(path: Path, _folder: Path, _config: RadarConfig) -> int:
    """flac -8 on the bare words."""
    raw = ["--force-raw-format", "--endian=little", "--sign=signed", "--bps=16", "--sample-rate=48000"]
    return min(len(_output(["flac", "-8", "-s", "-c", *raw, f"--channels={num}", str(path)])) for num in CHANNELS)


def wavpack(path: Path, folder: Path, _config: RadarConfig) -> int:
    """wavpack -hh -x on the bare words."""
    sizes = []
    for num in CHANNELS:
        _output(
            ["wavpack", "-q", "-y", "-hh", "-x3", f"--raw-pcm=48000,16s,{num},le", str(path), "-o", f"{folder}/a.wv"]
        )
        sizes.append((folder / "a.wv").stat().st_size)
    return min(sizes)


def blosc2(path: Path, _folder: Path, _config: RadarConfig) -> int:
    """zstd at level 9 after a bitshuffle of the words."""
    package = library("blosc2")
    options = {"codec": package.Codec.ZSTD, "clevel": 9, "typesize": 2, "filters": [package.Filter.BITSHUFFLE]}
    return len(package.compress2(path.read_bytes(), **options))


def jpegxl(path: Path, _folder: Path, config: RadarConfig) -> int:
    """JPEG XL without loss: a row of 16-bit pixels for each chirp and receiver."""
    words = np.fromfile(path, "<i2").astype(np.int32).reshape(-1, 2 * config.num_samples) + 32768
    return len(library("imagecodecs").jpegxl_encode(words.astype(np.uint16), lossless=True, effort=7, numthreads=1))


def sign_lms(path: Path, _folder: Path, _config: RadarConfig) -> int:
    """A stand-in for TTA: a sign-LMS filter of 16 taps a channel, then Rice codes, whose bits are counted."""
    words = np.fromfile(path, "<i2").astype(np.int64)
    return min(_sign_lms_bytes(words[: len(words) // num * num].reshape(-1, num)) for num in CHANNELS[2:])


def _sign_lms_bytes(samples: np.ndarray) -> int:
    weights, past = np.zeros((2, LMS_TAPS, samples.shape[1]), np.int64)
    errors = np.empty_like(samples)
    for index, sample in enumerate(samples):
        errors[index] = error = sample - ((weights * past).sum(axis=0) >> LMS_SHIFT)
        weights += np.sign(past) * np.sign(error)
        past[1:], past[0] = past[:-1], sample
    size = np.abs(errors)
    mean = lfilter([0.0, 1 / 32], [1.0, -31 / 32], size, axis=0)  # of the errors before
    digits = np.floor(np.log2(np.maximum(mean, 1))).astype(np.int64)
    return int(np.sum((2 * size >> digits) + 1 + digits)) // 8


RECORDINGS = {"office": office, "two_people": two_people}
CODECS: dict[str, Compress] = {
    "mmwl": ours, "zstd": by_tool("zstd", "-19", "-q", "-c", "--single-thread"), "xz": by_tool("xz", "-9e", "-k", "-c"),
    "flac": flac, "wavpack": wavpack, "blosc2": blosc2, "jpegxl": jpegxl,
    "sign_lms": sign_lms,
}  # fmt: skip


def _output(command: list[str]) -> bytes:
    return subprocess.run(command, check=True, capture_output=True).stdout


def _cpu_s() -> float:
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def codec_row(name: str, recording: str, data: Path) -> dict[str, Any]:
    """One codec on one recording; audio compressors are timed over all numbers of channels, ours with its decoding."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        path, config = RECORDINGS[recording](data, folder)
        raw, start = path.stat().st_size, _cpu_s()
        size = CODECS[name](path, folder, config)
        seconds = _cpu_s() - start
        digest = content_of(path)["sha256"][:16]
    share = {
        "value": round(size / raw, 4), "unit": "1", "version": 1, "baseline": {"raw": 1.0},
        "definition": "bytes of the compressed file over those of the raw words",
    }  # fmt: skip
    return {
        "dataset": {"name": recording, "origin": "recorded", "split": "one recording, compressed whole",
                    "sha256": digest, "shape": [raw // 2]},
        "n": 1, "seeds": [0], "seconds": {"cpu": round(seconds, 2)}, "size": {"bytes": size, "raw_bytes": raw},
        "metrics": {"share": share},
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--codecs", nargs="*", default=list(CODECS))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """Every codec on every recording; one file a codec."""
    for name in options.codecs:
        rows = [codec_row(name, recording, options.data) for recording in RECORDINGS]
        run.write(EXPERIMENT, name, config={}, rows=complete_rows(rows))
        print(name, [(row["size"]["bytes"], row["seconds"]["cpu"]) for row in rows], flush=True)
