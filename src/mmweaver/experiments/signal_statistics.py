"""Recorded frames beside simulated ones of the same kind and radar: where the energy is, how deep the noise lies.

python -m mmweaver.experiments.signal_statistics --data <recordings> --out results

The person who moves is simulated where one of the recorded ones is; the resting room is the sample room, so there
only the kind of number can agree.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence
from mmweaver.dsp.cube import radar_cube, remove_static
from mmweaver.dsp.spectra import moving_doppler, range_doppler_power
from mmweaver.experiments.empty_room import empty_room
from mmweaver.experiments.results import write_result
from mmweaver.experiments.signals import pose_of, sample_scene, two_people_radar
from mmweaver.formats.dca1000 import read_bin
from mmweaver.formats.mmwave_studio import read_mmwave_studio
from mmweaver.formats.raw_npy import read_adc_npy
from mmweaver.simulation.simulator import Simulator

EXPERIMENT = "signal_statistics"
VERSION = 1
WALKER_M, WALKER_RAD, WALL_M = 2.93, float(np.radians(-15.0)), 5.2
DEFINITIONS: dict[str, tuple[str, str]] = {
    "static_share": ("share", "energy of the mean over a frame's loops, of all energy in the kept range bins"),
    "top_1_percent": ("share", "energy of the strongest 1 % of range-Doppler-antenna cells"),
    "top_5_percent": ("share", "energy of the strongest 5 % of the cells"),
    "peak_over_median_db": ("dB", "strongest over median range-Doppler cell, mean over antennas"),
    "moving_over_median_db": ("dB", "the same once the mean over the loops is taken away"),
    "doppler_spread_mps": ("m/s", "width of the Doppler bins within 20 dB of the strongest, static taken away"),
    "floor_slope_db": (
        "dB",
        "noise (median far from zero Doppler) of the nearest third of the range over the farthest",
    ),
}


def statistics(adc: AdcCube) -> dict[str, float]:
    """The numbers of DEFINITIONS for one recording."""
    cube = radar_cube(adc)
    moving = remove_static(cube)
    cells = np.sort(np.abs(cube.values).ravel() ** 2)[::-1]
    total = float(cells.sum())
    power, moving_power = range_doppler_power(cube), range_doppler_power(moving)
    by_doppler = moving_power[:, :, moving_doppler(cube)].sum(axis=(0, 1))
    velocity = cube.grid.radial_velocity_mps[moving_doppler(cube)]
    strong = velocity[by_doppler > 0.01 * by_doppler.max()]
    far = np.abs(cube.grid.radial_velocity_mps) > 0.75 * cube.config.max_velocity_mps
    floor = np.median(power[:, :, far], axis=(0, 2))
    third = len(floor) // 3
    return {
        "static_share": 1 - float((np.abs(moving.values) ** 2).sum()) / total,
        "top_1_percent": float(cells[: len(cells) // 100].sum()) / total,
        "top_5_percent": float(cells[: len(cells) // 20].sum()) / total,
        "peak_over_median_db": _db(power.max() / np.median(power)),
        "moving_over_median_db": _db(moving_power.max() / np.median(moving_power)),
        "doppler_spread_mps": float(strong.max() - strong.min()),
        "floor_slope_db": _db(np.median(floor[:third]) / np.median(floor[-third:])),
    }


def _db(ratio: float) -> float:
    return float(10 * np.log10(ratio))


def recorded_people(data: Path) -> AdcCube:
    """Two people who move, one frame of 128 loops."""
    path = data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy"
    return read_adc_npy(path, two_people_radar(num_loops=128), "loop,vrx,sample")


def recorded_hall(data: Path) -> AdcCube:
    """A hall in which nothing moves, one frame of 85 loops."""
    folder = data / "radar" / "iwr6843_dca1000"
    return read_bin(folder / "adc_data_example.bin", read_mmwave_studio(folder / "mmwaveDevice.mmwave.json"))


def simulated(config: RadarConfig, seed: int, *, is_empty: bool) -> AdcCube:
    """One frame before the given radar: the sample room with nobody in it, or a person who walks at the recorded place.

    One of the two recorded people is at 2.93 m and -15 degrees, with a wall at 5.2 m.
    """
    pose = pose_of("walking", seconds=2.0, seed=seed)
    middle_s = float(np.mean(pose.time_s))
    pelvis = pose.joints_m[len(pose.time_s) // 2, 0]
    place = np.array([0.0, 200.0]) if is_empty else WALKER_M * np.array([np.sin(WALKER_RAD), np.cos(WALKER_RAD)])
    shifted = pose.joints_m + np.append(place - pelvis[:2], 0.0)
    from_middle = PoseSequence(
        time_s=pose.time_s - middle_s, joints_m=shifted, height_m=pose.height_m, subject=pose.subject
    )
    room = sample_scene() if is_empty else empty_room(floor_z_m=float(shifted[..., 2].min()) - 0.04, wall_y_m=WALL_M)
    return Simulator(room, config).run(from_middle, num_frames=1, seed=seed).adc


def rows(name: str, recording: AdcCube, *, is_empty: bool, seeds: tuple[int, ...]) -> list[dict[str, Any]]:
    """The recording's row and that of simulated frames, with their spread over seeds."""
    real = statistics(recording)
    config = replace(recording.config, tx_power_dbm=12.0)
    made = [statistics(simulated(config, seed, is_empty=is_empty)) for seed in seeds]
    spread = {key: [float(np.min([m[key] for m in made])), float(np.max([m[key] for m in made]))] for key in real}
    middle = {key: float(np.median([m[key] for m in made])) for key in real}
    return [
        _row(name, "recorded", real, None, 1, ()),
        _row(name, "simulated", middle, spread, len(seeds), seeds),
    ]


def _row(
    name: str, origin: str, values: dict[str, float], spread: dict[str, list[float]] | None, n: int, seeds: tuple
) -> dict[str, Any]:
    metrics = {}
    for key, (unit, definition) in DEFINITIONS.items():
        metrics[key] = {"value": round(values[key], 4), "unit": unit, "definition": definition, "version": VERSION}
        if spread:
            metrics[key]["interval"] = [round(edge, 4) for edge in spread[key]]
    return {"dataset": {"name": name, "origin": origin}, "n": n, "seeds": list(seeds), "metrics": metrics}


RECORDINGS: tuple[tuple[str, Callable[[Path], AdcCube], bool], ...] = (
    ("people who move", recorded_people, False),
    ("a room in which nothing moves", recorded_hall, True),
)


def run(out: Path, data: Path, seeds: tuple[int, ...] = tuple(range(10))) -> Path:
    """Both recordings, each with simulated frames of the same radar."""
    found = [row for name, read, empty in RECORDINGS for row in rows(name, read(data), is_empty=empty, seeds=seeds)]
    return write_result(
        out,
        experiment=EXPERIMENT,
        method="physics",
        config={"rooms": "a floor and a wall at 5.2 m; bundled sample"},
        rows=found,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("results"))
    parser.add_argument("--data", type=Path, required=True, help="folder of recordings (with radar/ in it)")
    arguments = parser.parse_args()
    run(arguments.out, arguments.data)


if __name__ == "__main__":
    main()
