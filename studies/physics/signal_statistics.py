"""Statistics of recorded frames and of simulated ones of the same kind and radar: energy and noise.

python -m studies run signal_statistics --data <recordings>

The moving person is simulated at the place of a recorded one; the static room is the sample room, so only the order of
magnitude can agree; the breathing person stands with the chest where the recorded one is. The spread among real frames
is measured on quarters of each recording, and on the same quarters of simulated ones.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import BGT60, find_board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence, RadarCube, Scene
from mmweaver.core.skeleton import joint
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.mmwave_studio import read_mmwave_studio
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import Propagation
from mmweaver.signal.cube import radar_cube, remove_static
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from studies.fields.field_signals import pose_of, sample_scene, two_people_radar
from studies.manifest import StudyRun
from studies.physics.empty_room_cube import empty_room
from studies.result_rows import complete_rows
from studies.study import Reads

EXPERIMENT = "signal_statistics"
VERSION = 2
QUARTERS = 4
CHEST_M, CHEST_HEIGHT, PELVIS_BEHIND_CHEST_M = 0.33, 0.72, 0.13
STRONGEST, ANGLES = 20, 2048
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
    "antenna_phase_deg": (
        "degrees",
        "rms over the horizontal antennas of what is left of the phase after the best plane wave; median of the 20"
        " strongest cells within 20 dB",
    ),
}


def statistics(adc: AdcCube) -> dict[str, float]:
    """The metrics of DEFINITIONS of one recording."""
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
    phase_deg = antenna_phase_deg(cube)
    found = {
        "static_share": 1 - float((np.abs(moving.values) ** 2).sum()) / total,
        "top_1_percent": float(cells[: len(cells) // 100].sum()) / total,
        "top_5_percent": float(cells[: len(cells) // 20].sum()) / total,
        "peak_over_median_db": _db(power.max() / np.median(power)),
        "moving_over_median_db": _db(moving_power.max() / np.median(moving_power)),
        "doppler_spread_mps": float(strong.max() - strong.min()),
        "floor_slope_db": _db(np.median(floor[:third]) / np.median(floor[-third:])),
    }
    return found if phase_deg is None else {**found, "antenna_phase_deg": phase_deg}


def antenna_phase_deg(cube: RadarCube) -> float | None:
    """Deviation of the strongest cells from plane waves over the horizontal row; None for a row of two or fewer."""
    place_m, wavelength_m = cube.grid.antenna_position_m, cube.grid.wavelength_m
    row = azimuth_row(place_m, wavelength_m)
    if len(row) < 3:
        return None
    values = cube.values.reshape(-1, cube.values.shape[-1])[:, row].astype(np.complex128)
    power = (np.abs(values) ** 2).sum(axis=1)
    strong = np.argsort(power)[-STRONGEST:]
    strong = values[strong[power[strong] > 0.01 * power.max()]]
    across = np.linspace(-1, 1, ANGLES)
    waves = np.exp(2j * np.pi / wavelength_m * across[:, None] * place_m[row, 0])  # (angle, antenna)
    beams = strong @ waves.conj().T
    best = np.argmax(np.abs(beams), axis=1)
    turned = strong * waves[best].conj() * np.exp(-1j * np.angle(beams[np.arange(len(best)), best]))[:, None]
    return float(np.median(np.degrees(np.sqrt((np.angle(turned) ** 2).mean(axis=1)))))


def quarters(adc: AdcCube) -> list[AdcCube]:
    """A recording of one frame divided into four shorter frames."""
    loops = adc.config.num_loops // QUARTERS
    config = replace(adc.config, num_loops=loops)
    return [
        replace(adc, samples=adc.samples[:, at * loops : (at + 1) * loops], config=config) for at in range(QUARTERS)
    ]


def _db(ratio: float) -> float:
    return float(10 * np.log10(ratio))


def recorded_people(data: Path) -> AdcCube:
    """Two moving people, one frame of 128 loops."""
    path = data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy"
    return read_adc_npy(path, two_people_radar(num_loops=128), "loop,vrx,sample")


def recorded_hall(data: Path) -> AdcCube:
    """A static hall, one frame of 85 loops."""
    folder = data / "radar" / "iwr6843_dca1000"
    return read_bin(folder / "adc_data_example.bin", read_mmwave_studio(folder / "mmwaveDevice.mmwave.json"))


def recorded_breath(data: Path) -> AdcCube:
    """A person who breathes 0.33 m away, as one long frame with a loop every 77 ms."""
    path = data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    return slow_frame(read_adc_npy(path, BGT60, "frame,rx,loop,sample"))


def slow_frame(adc: AdcCube) -> AdcCube:
    """Many short frames as one: the mean chirp of each becomes a loop of it."""
    period_s, num = adc.config.frame_period_s, len(adc.samples)
    idle_s = period_s / adc.config.num_tx - adc.config.ramp_end_time_s
    config = replace(adc.config, num_loops=num, idle_time_s=idle_s, frame_period_s=1.001 * num * period_s)
    return replace(adc, samples=adc.samples.mean(axis=1)[None].astype(np.complex64), config=config)


def sample_room(config: RadarConfig, seed: int) -> AdcCube:
    """One frame of the sample room with nobody in it."""
    return simulator(sample_scene(), config, seed).run((), num_frames=1, seed=seed).adc


def simulator(room: Scene, config: RadarConfig, seed: int) -> Simulator:
    """The physics as `generate` runs it, with a typical board."""
    board = find_board("typical", config, seed)
    return Simulator(room, config, propagation=Propagation(clutter=True), board=board)


def walker(config: RadarConfig, seed: int) -> AdcCube:
    """One frame of a person walking at the place of a recorded one, with a wall where the recording has it."""
    pose = pose_of("walking", seconds=2.0, seed=seed)
    middle_s = float(np.mean(pose.time_s))
    pelvis = pose.joints_m[len(pose.time_s) // 2, 0]
    place = WALKER_M * np.array([np.sin(WALKER_RAD), np.cos(WALKER_RAD)])
    shifted = pose.joints_m + np.append(place - pelvis[:2], 0.0)
    from_middle = replace(pose, time_s=pose.time_s - middle_s, joints_m=shifted)
    room = empty_room(floor_z_m=float(shifted[..., 2].min()) - 0.04, wall_y_m=WALL_M)
    return simulator(room, config, seed).run(from_middle, num_frames=1, seed=seed).adc


def breathing_pose(seed: int, frames: int) -> tuple[PoseSequence, float]:
    """Somebody who stands with the chest 0.33 m ahead of the radar, facing it, and where the floor is (z, m)."""
    standing = pose_of("waving", seconds=1.0, seed=seed)  # it begins in a stance
    joints_m = standing.joints_m[:1] - standing.joints_m[:1, :1] * np.array([1.0, 1.0, 0.0])
    floor_m = float(joints_m[..., 2].min()) - 0.04
    chest_m = floor_m + CHEST_HEIGHT * standing.height_m
    towards = joints_m[0, joint("left_hip")] - joints_m[0, joint("right_hip")]
    turn = np.arctan2(towards[1], towards[0])  # who faces the radar has the left hip to the right
    cos, sin = np.cos(turn), np.sin(turn)
    turned = joints_m @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    place = turned + np.array([0.0, CHEST_M + PELVIS_BEHIND_CHEST_M, -chest_m])
    time_s = np.array([0.0, 0.5, 1.0]) * frames * BGT60.frame_period_s
    return replace(standing, time_s=time_s, joints_m=np.repeat(place, 3, axis=0)), floor_m - chest_m


def breather(config: RadarConfig, seed: int) -> AdcCube:
    """A person who stands and only breathes, placed as the recorded one of `recorded_breath`."""
    pose, floor_z_m = breathing_pose(seed, config.num_loops)
    room = empty_room(floor_z_m=floor_z_m, wall_y_m=None)
    made = simulator(room, BGT60, seed).run(pose, num_frames=config.num_loops, seed=seed)
    return slow_frame(made.adc)


def rows(
    name: str, recording: AdcCube, simulate: Callable[[RadarConfig, int], AdcCube], seeds: tuple[int, ...]
) -> list[dict[str, Any]]:
    """The recording's row and that of simulated frames, with their spread over seeds and over quarters."""
    real = statistics(recording)
    made = [simulate(replace(recording.config, tx_power_dbm=12.0), seed) for seed in seeds]
    each = [statistics(one) for one in made]
    middle = {key: float(np.median([found[key] for found in each])) for key in real}
    parts = [statistics(part) for one in made for part in quarters(one)]
    return [
        _row(name, "recorded", real, None, _spread([statistics(part) for part in quarters(recording)]), ()),
        _row(name, "simulated", middle, _spread(each), _spread(parts), seeds),
    ]


def _spread(found: list[dict[str, float]]) -> dict[str, list[float]]:
    return {key: [min(one[key] for one in found), max(one[key] for one in found)] for key in found[0]}


def _row(
    name: str, origin: str, values: dict[str, float], spread: dict[str, list[float]] | None,
    parts: dict[str, list[float]], seeds: tuple[int, ...],
) -> dict[str, Any]:  # fmt: skip
    metrics: dict[str, dict[str, Any]] = {}
    for key, value in values.items():
        unit, definition = DEFINITIONS[key]
        metrics[key] = {"value": round(value, 4), "unit": unit, "definition": definition, "version": VERSION}
        metrics[key]["quarters"] = [round(edge, 4) for edge in parts[key]]
        if spread:
            metrics[key]["lowest_highest"] = [round(edge, 4) for edge in spread[key]]
    return {
        "dataset": {"name": name, "origin": origin},
        "n": max(len(seeds), 1),
        "seeds": list(seeds),
        "metrics": metrics,
    }


UNKNOWN = {
    "dataset.sha256": "recordings are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
    "metrics.*.baseline": "statistics of a signal; the simulated rows are compared with the recorded ones",
}
RECORDINGS: tuple[tuple[str, Callable[[Path], AdcCube], Callable[[RadarConfig, int], AdcCube]], ...] = (
    ("people who move", recorded_people, walker),
    ("a room in which nothing moves", recorded_hall, sample_room),
    ("a person who breathes", recorded_breath, breather),
)


def measure(run: StudyRun, data: Path, seeds: tuple[int, ...] = tuple(range(10))) -> Path:
    """All recordings, each with simulated frames of the same radar."""
    found = [row for name, read, simulate in RECORDINGS for row in rows(name, read(data), simulate, seeds)]
    config = {"rooms": "a floor and a wall at 5.2 m; bundled sample; a floor", "quarters": QUARTERS}
    return run.write(EXPERIMENT, "physics", config=config, rows=complete_rows(found, unknown=UNKNOWN))


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, required=True, help="folder of recordings (with radar/ in it)"
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run, options.data)
