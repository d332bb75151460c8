"""What the scatterers of .mmw are worth, and where a bound for Gaussian fields lies.

python -m studies run codec_limits --data <recordings>
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter

from mmweaver.compression.chunk_encoder import ChunkEncoder, Scale, some_frames, split
from mmweaver.compression.optimiser import SHORT_CHUNK
from mmweaver.compression.transforms import ChunkTransform, TransformChoice, transform_choices
from mmweaver.core.records import RadarCube
from studies.baselines.mmweaver_codec import Mmw
from studies.fields.codecs import codec_row
from studies.fields.field_signals import SIGNALS, StudySignal
from studies.fields.recording_cuts import CUTS
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

EXPERIMENT = "codec_limits"
SIZES = (2504, 10018)
USUAL = ("office, 1 frame", "two people, 4 frames", "two people, 1 frame, 1 antenna", "breathing, 256 frames", "waving")
NEIGHBOURHOOD = (1, 3, 3, 3)  # (direction, time, range, Doppler) over which the power of a field is measured
BISECTIONS, LEAST_POWER = 60, 1e-30


def gaussian_bound(cube: RadarCube, num_bytes: int) -> dict[str, float | None]:
    """Errors in dB of reverse water-filling over a Gaussian field with the powers of this cube, all cells alike.

    Powers are those of the antennas' principal directions, of the DCT over frames in static Doppler bins, and of cells,
    in the mean over neighbouring coefficients; the decoder knows them for nothing. Real fields are not Gaussian, and a
    codec may spend its bits on active cells, so that it may be better: it is an estimate, not a limit.
    """
    scale, powers, masks, energy = Scale.of(cube), [], [], np.zeros(2)
    for part in split(len(cube.values), SHORT_CHUNK):
        encoder = ChunkEncoder(some_frames(cube, part), scale)
        time = transform_choices(encoder.target.shape)[0].time
        choice = TransformChoice(time=time, antenna_klt=encoder.target.shape[3] > 1)
        transform = ChunkTransform.of(choice, encoder.target, encoder.beams)
        power = np.abs(transform.forward(encoder.target)).astype(np.float64) ** 2
        mask = np.broadcast_to(transform.spread(encoder.is_active), power.shape)
        energy += float(power.sum()), float(power[mask].sum())
        powers.append(uniform_filter(power, NEIGHBOURHOOD).ravel())
        masks.append(mask.ravel())
    power, is_active = np.maximum(np.concatenate(powers), LEAST_POWER), np.concatenate(masks)
    low, high = np.log(LEAST_POWER), float(np.log(power.max()))
    for _ in range(BISECTIONS):
        level = (low + high) / 2
        bits = np.sum(np.log2(np.maximum(power / np.exp(level), 1)))  # complex: log2(power / error) each
        low, high = (level, high) if bits > 8 * num_bytes else (low, level)
    error = np.minimum(power, np.exp(high))
    lost = np.array([error.sum(), error[is_active].sum()]) / energy
    whole, active = (round(10 * float(np.log10(one)), 2) for one in lost)
    return {"nmse_db": whole, "nmse_active_db": active, "nmse_moving_db": None}


def bound_row(row: dict[str, Any], signal: StudySignal) -> dict[str, Any]:
    """A codec's row with the errors of the bound."""
    num_bytes = row["size"]["bytes_allowed"]
    found = gaussian_bound(signal.cube, num_bytes)
    metrics = {name: metric | {"value": found[name]} for name, metric in row["metrics"].items()}
    return row | {"metrics": metrics, "seconds": {}, "size": {"bytes_allowed": num_bytes, "bytes": num_bytes}}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--signals", nargs="*", default=list(USUAL))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    """.mmw with and without scatterers, and the bound; one file each."""
    signals = [(CUTS if name in CUTS else SIGNALS)[name](options.data) for name in options.signals]
    methods = {"mmw": Mmw(), "without scatterers": Mmw(effort="fast")}
    both = [(signal, size) for signal in signals for size in SIZES]
    rows: list[dict[str, Any]] = []
    for name, codec in methods.items():
        rows = [codec_row(codec, signal, size) for signal, size in both]
        run.write(EXPERIMENT, name.replace(" ", "_"), config={"sizes": list(SIZES)}, rows=complete_rows(rows))
        print(json.dumps({"codec": name}), flush=True)
    bounds = [bound_row(row, signal) for row, (signal, _) in zip(rows, both, strict=True)]
    run.write(EXPERIMENT, "gaussian_bound", config={"sizes": list(SIZES)}, rows=complete_rows(bounds))
