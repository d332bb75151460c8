"""Error of radar cubes coded into 2.5 to 40 KB: .mmw, classical codecs, tensor factorizations and the paper's INR.

python -m studies run codecs --data <recordings>        (needs the extra `codecs`)
"""

import argparse
import json
import math
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.mmw_codec import compress_cube, read_cube
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.registry import Registry
from mmweaver.core.shapes import CubeValues
from studies.baselines.codec_interface import Codec
from studies.baselines.coefficient_codecs import KltContext, TopCoefficients
from studies.baselines.library_codecs import Blosc2, Jpeg2000, JpegXl, Sperr
from studies.baselines.network_codecs import InrInBytes
from studies.baselines.tensor_codecs import Cp, TruncatedSvd, Tucker
from studies.fields.field_signals import RECORDED, SIGNALS, StudySignal
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scores.cube_scores import BASELINES, cells_of, nmse_db
from studies.scores.scorecard import METRICS
from studies.study import Reads

EXPERIMENT = "codecs"
SIZES = (2504, 5009, 10018, 20036, 40072)
SCORES = ("nmse_db", "nmse_active_db", "nmse_moving_db")


class Mmw(Codec):
    """Scatterers, static layer and residual in a .mmw file; with `keep_noise`, noise cells have the same weight as
    others."""

    def __init__(self, *, keep_noise: bool = False, effort: str = "full"):
        self.keep_noise, self.effort = keep_noise, effort
        self.name = "mmw_keep_noise" if keep_noise else "mmw"

    def encoded(self, cube: RadarCube, num_bytes: int) -> bytes | None:
        try:
            return compress_cube(cube, num_bytes=num_bytes, keep_noise=self.keep_noise, effort=self.effort)
        except InputError:
            return None

    def decoded(self, data: bytes, like: RadarCube) -> CubeValues:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "cube.mmw"
            path.write_bytes(data)
            return read_cube(path).values


CODECS: Registry[Callable[[], Codec]] = Registry(
    "codec",
    [
        ("mmw", Mmw), ("mmw_keep_noise", lambda: Mmw(keep_noise=True)),
        ("klt_context", KltContext), ("top_klt", TopCoefficients), ("sperr", Sperr), ("blosc2", Blosc2),
        ("jpeg2000", Jpeg2000), ("jpegxl", JpegXl), ("svd", TruncatedSvd), ("tucker", Tucker), ("cp", Cp),
        ("inr_paper", lambda: InrInBytes("paper")),
        ("inr_smooth_short", lambda: InrInBytes("smooth_short")),
    ],
)  # fmt: skip


def codec_row(codec: Codec, signal: StudySignal, num_bytes: int) -> dict[str, Any]:
    """One codec at one size on one cube; scores are None where it cannot be so small."""
    cube = signal.cube
    start, start_cpu = time.perf_counter(), time.process_time()
    data = codec.encoded(cube, num_bytes)
    encode_s, encode_cpu_s = time.perf_counter() - start, time.process_time() - start_cpu
    decode_s: float | None = None
    scores: dict[str, float | None] = dict.fromkeys(SCORES)
    if data is not None:
        if len(data) > num_bytes:
            raise RuntimeError(f"{codec.name} wrote {len(data)} bytes where {num_bytes} were allowed")
        start = time.perf_counter()
        values = codec.decoded(data, replace(cube, values=np.zeros_like(cube.values)))
        decode_s = round(time.perf_counter() - start, 3)
        scores = errors_db(values, cube)
    return {
        "dataset": {
            "name": signal.name,
            "origin": signal.origin,
            "split": "one sequence, coded and scored on all its cells",
            "sha256": signal.digest,
            "shape": list(cube.grid.shape),
        },
        "n": 1,
        "seeds": [0],
        "seconds": {"encode": round(encode_s, 2), "encode_cpu": round(encode_cpu_s, 2), "decode": decode_s},
        "size": {"bytes_allowed": num_bytes, "bytes": None if data is None else len(data)},
        "metrics": _metrics(scores, cube),
    }


def errors_db(values: np.ndarray, truth: RadarCube) -> dict[str, float | None]:
    """NMSE over all, active and moving cells; None where there are none."""
    cells = cells_of(truth)
    where = (None, cells.is_active, cells.is_moving)
    found = [nmse_db(values, truth.values, chosen) for chosen in where]
    return {name: round(value, 2) if math.isfinite(value) else None for name, value in zip(SCORES, found, strict=True)}


def _metrics(scores: dict[str, Any], truth: RadarCube) -> dict[str, Any]:
    baselines = {name: errors_db(make(truth).values, truth) for name, make in BASELINES.items()}
    return {
        name: {
            "value": scores[name],
            "unit": METRICS[name].unit,
            "definition": METRICS[name].definition,
            "version": METRICS[name].version,
            "baseline": {other: values[name] for other, values in baselines.items()},
        }
        for name in SCORES
    }


def measure(
    run: StudyRun,
    codec_names: list[str],
    signal_names: list[str],
    data: Path | None,
    sizes: tuple[int, ...],
) -> None:
    """Every codec on every signal at every size; one file a codec, written when the codec is done."""
    signals = [SIGNALS[name](data) for name in signal_names]
    for name in codec_names:
        codec = CODECS[name]()
        rows = [codec_row(codec, signal, size) for signal in signals for size in sizes]
        path = run.write(EXPERIMENT, name, config={"sizes": list(sizes)}, rows=complete_rows(rows))
        print(json.dumps({"codec": name, "written": str(path)}), flush=True)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, default=None, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--codecs", nargs="*", default=list(CODECS))
    parser.add_argument("--signals", nargs="*", default=None)
    parser.add_argument("--sizes", nargs="*", type=int, default=SIZES)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    every = [name for name in SIGNALS if options.data is not None or name not in RECORDED]
    signals = options.signals or every
    measure(run, options.codecs, signals, options.data, tuple(options.sizes))
