"""Recorded and simulated point clouds of the same poses, frame by frame: the MARS recordings.

The simulator is driven by the joints of the Kinect and its samples pass through the firmware's detection chain. Seven
global parameters are unknown and are estimated on `validate`: the position of the radar in the Kinect's frame (3), the
receiver's gain, the CFAR threshold, the phase offset of the elevation transmitter and the person's height. That clutter
removal was on and peak grouping off follows from the recordings. `test` is only scored.

    python -m studies run mars --data shared/data/pointclouds/mars/subject1
    python -m studies run mars --split validate --data shared/data/pointclouds/mars/subject1

With `--split validate` the simulator as it is today is scored on all sections of `validate` that estimated nothing,
next to what the recording itself gives when the person takes the same pose again: `test` is left alone.
"""

import argparse
import hashlib
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mmweaver.core.board import Board
from mmweaver.core.boards import IWR1443_MARS
from mmweaver.core.firmware_settings import FIRMWARE, FirmwareSettings
from mmweaver.core.records import AdcCube, PointCloud
from mmweaver.core.seeding import stream
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import AS_PUBLISHED
from mmweaver.signal.firmware import FirmwareCloud, firmware_points
from studies.manifest import StudyRun
from studies.physics.cloud_scores import CloudScores, part_of, score
from studies.physics.empty_room_cube import empty_room
from studies.physics.mars_data import FRAME_S, MarsStretch, as_published, body_height_m, cut, pose_of, read_mars
from studies.result_rows import complete_rows
from studies.study import Reads

PIECE_FRAMES, PIECES, MOST_PIECES = 20, 20, 10_000
HEIGHTS_M = (0.2, 0.0, 0.1, 0.3, 0.4, 0.5, 0.6)  # the first is where the estimation begins
THRESHOLDS = (400, 2000)
ELEVATIONS_DEG = (0.0, -12.0, -8.0, -4.0, 4.0, 8.0, 12.0)  # as far as boards were seen to be off (docs/board.md)
PIECES_TO_ESTIMATE = 12
NUM_POINTS = 800  # of the skin
AGAIN_FRAMES, VELOCITY_WEIGHT_S = 10, 0.3  # at least a second later; how far velocities count in a pose's likeness
Clouds = list[tuple[PointCloud, ...]]  # one tuple a piece, one cloud a sample


@dataclass(frozen=True, kw_only=True)
class Setup:
    """The estimated parameters; all are global, none belongs to a frame."""

    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)  # from the Kinect's frame to the radar's
    gain_db: float = 0.0  # against the preset's receiver
    threshold: int = 768
    elevation_deg: float = 0.0  # phase of the elevated transmitter
    height_m: float = 1.75


def settings_of(setup: Setup) -> FirmwareSettings:
    """The settings of the firmware with the estimated threshold."""
    base = FIRMWARE["iwr1443_mars"]
    assert base.range_cfar is not None, "the preset has a CFAR in range"
    return replace(base, range_cfar=replace(base.range_cfar, threshold=setup.threshold))


def simulate(pieces: list[MarsStretch], setup: Setup, seed: int = 0) -> list[AdcCube]:
    """ADC samples of each piece, in a room of a floor alone."""
    feet_m = min(float(piece.joints_m[..., 2].min()) for piece in pieces) + setup.shift_m[2]
    simulator = Simulator(empty_room(floor_z_m=feet_m - 0.04), IWR1443_MARS, propagation=AS_PUBLISHED)
    adcs = []
    for piece in pieces:
        pose = pose_of(replace(piece, joints_m=smoothed(piece.joints_m)), setup.shift_m, setup.height_m)
        adcs.append(simulator.run(pose, num_frames=int(piece.frame[-1]) + 1, seed=seed, num_points=NUM_POINTS).adc)
    return adcs


def smoothed(joints_m: np.ndarray) -> np.ndarray:
    """The Kinect's joints tremble by a centimetre from frame to frame: Gaussian smoothing of a frame."""
    return gaussian_filter1d(joints_m, 1.0, axis=0, mode="nearest")


def detect(adcs: list[AdcCube], pieces: list[MarsStretch], setup: Setup) -> Clouds:
    """Detections of the firmware's chain at the recorded frames, cropped to the box of the recordings."""
    settings, clouds = settings_of(setup), []
    for adc, piece in zip(adcs, pieces, strict=True):
        cloud = as_published(firmware_points(received(adc, setup), settings))
        clouds.append(tuple(part_of(cloud, int(frame)) for frame in piece.frame))
    return clouds


def received(adc: AdcCube, setup: Setup) -> AdcCube:
    """Samples with the estimated gain, by a board with the estimated phase of the elevated transmitter."""
    samples = adc.samples * np.float32(10 ** (setup.gain_db / 20))
    channels = BoardEffects(Board(elevation_phase_deg=setup.elevation_deg), adc.config).channels
    if channels is not None:
        samples *= channels.diagonal().reshape(adc.config.num_tx, adc.config.num_rx, 1).numpy()
    return replace(adc, samples=samples)


# estimation ---------------------------------------------------------------------------------------------------------
def calibrate(pieces: list[MarsStretch], report: Callable[[str], object] = print) -> Setup:
    """The global parameters, from `validate` alone.

    Position from the median distance of the centroids of the clouds; gain from the median intensity and threshold from
    the mean number of points; height, then the elevation's phase, from the Chamfer distance, as the beam fixes the
    height of the centroid wherever the body is.
    """
    real: Clouds = [piece.clouds for piece in pieces]
    setup = Setup(height_m=round(body_height_m(pieces), 2), shift_m=(0.0, 0.0, HEIGHTS_M[0]))
    setup = _own_levels(pieces, _centred(pieces, setup, real), real)
    x, y, _ = setup.shift_m
    tried = [replace(setup, shift_m=(x, y, z)) for z in HEIGHTS_M]
    setup = _best(tried, [_simulated(pieces, one) for one in tried], real, report)
    adcs, tried = simulate(pieces, setup), [replace(setup, elevation_deg=degrees) for degrees in ELEVATIONS_DEG]
    setup = _best(tried, [detect(adcs, pieces, one) for one in tried], real, report)
    setup = _own_levels(pieces, _centred(pieces, setup, real), real)
    report(f"estimated: {setup}")
    return setup


def _best(tried: list[Setup], clouds: list[Clouds], real: Clouds, report: Callable[[str], object]) -> Setup:
    """The setup whose clouds are nearest to the recorded ones."""
    distance = [score(one, real).value("chamfer_m") for one in clouds]
    for setup, found in zip(tried, distance, strict=True):
        report(f"Chamfer {found:.3f} m: {setup}")
    return tried[int(np.argmin(distance))]


def _centred(pieces: list[MarsStretch], setup: Setup, real: Clouds) -> Setup:
    """The position of the radar shifted sideways and in depth until the centroids agree."""
    right, ahead, _ = _centroid_offset(_simulated(pieces, setup), real)
    x, y, z = setup.shift_m
    return replace(setup, shift_m=(round(float(x - right), 3), round(float(y - ahead), 3), z))


def _centroid_offset(ours: Clouds, real: Clouds) -> np.ndarray:
    both = [
        (a, b) for one, other in zip(ours, real, strict=True) for a, b in zip(one, other, strict=True) if len(a.x_m)
    ]
    return np.median([_middle(a) - _middle(b) for a, b in both], axis=0)


def _middle(cloud: PointCloud) -> np.ndarray:
    return np.array([cloud.x_m.mean(), cloud.y_m.mean(), cloud.z_m.mean()])


def _own_levels(pieces: list[MarsStretch], setup: Setup, real: Clouds) -> Setup:
    adcs = simulate(pieces, setup)
    return levels(setup, real, lambda tried: detect(adcs, pieces, tried))


def levels(setup: Setup, real: Clouds, detected: Callable[[Setup], Clouds]) -> Setup:
    """Gain, then threshold, twice: the threshold decides which intensities remain."""
    wanted = np.mean([len(cloud.x_m) for piece in real for cloud in piece])
    for _ in range(2):
        setup = replace(setup, gain_db=round(setup.gain_db + _median_db(real) - _median_db(detected(setup)), 1))
        low, high = THRESHOLDS
        while high - low > 30:
            middle = (low + high) // 2
            clouds = detected(replace(setup, threshold=middle))
            many = np.mean([len(cloud.x_m) for piece in clouds for cloud in piece]) > wanted
            low, high = (middle, high) if many else (low, middle)
        setup = replace(setup, threshold=(low + high) // 2)
    return setup


def _median_db(clouds: Clouds) -> float:
    levels = [cloud.intensity for piece in clouds for cloud in piece if isinstance(cloud, FirmwareCloud)]
    return float(20 * np.log10(np.median(np.concatenate(levels))))


# baselines and oracle -------------------------------------------------------------------------------------------------
def centroid_baseline(pieces: list[MarsStretch], setup: Setup) -> Clouds:
    """One point at the middle of the joints."""
    return [
        tuple(_points(joints.mean(axis=0)[None] + np.asarray(setup.shift_m)) for joints in piece.joints_m)
        for piece in pieces
    ]


def surface_baseline(pieces: list[MarsStretch], setup: Setup, num: int) -> Clouds:
    """As many points as an average frame has, anywhere on the skin of the body."""
    body = ScatteringBody(0, setup.height_m)
    clouds: Clouds = []
    for index, piece in enumerate(pieces):
        skin = body.skin(piece.joints_m + np.asarray(setup.shift_m)).place_m
        rng = stream(0, "surface floor", index)
        clouds.append(tuple(_points(place[rng.choice(len(place), num, replace=False)]) for place in skin))
    return clouds


def random_frame_baseline(pieces: list[MarsStretch], pool: list[MarsStretch]) -> Clouds:
    """Any real frame of the other split."""
    every = [cloud for stretch in pool for cloud in stretch.clouds]
    rng = stream(0, "random frame floor")
    return [tuple(every[rng.integers(len(every))] for _ in piece.clouds) for piece in pieces]


def neighbour_oracle(pieces: list[MarsStretch]) -> Clouds:
    """The previous real frame; for the first frame the next."""
    return [(piece.clouds[1], *piece.clouds[:-1]) for piece in pieces]


def same_pose_oracle(pieces: list[MarsStretch], stretches: list[MarsStretch]) -> Clouds:
    """The real frame whose joints and their velocities are the most alike, a second or more away in the recording.

    What a radar gives twice of one pose: nobody who knows the joints alone can be expected to do better. Where a
    recording is too short, the neighbouring frame.
    """
    of_cloud = {id(cloud): (stretch, at) for stretch in stretches for at, cloud in enumerate(stretch.clouds)}
    likeness = {id(stretch): _posture(stretch) for stretch in stretches}
    clouds: Clouds = []
    for piece, neighbours in zip(pieces, neighbour_oracle(pieces), strict=True):
        again = []
        for cloud, neighbour in zip(piece.clouds, neighbours, strict=True):
            stretch, at = of_cloud[id(cloud)]
            posture = likeness[id(stretch)]
            apart = ((posture - posture[at]) ** 2).sum(axis=1)
            apart[np.abs(stretch.frame - stretch.frame[at]) < AGAIN_FRAMES] = np.inf
            again.append(stretch.clouds[int(apart.argmin())] if np.isfinite(apart).any() else neighbour)
        clouds.append(tuple(again))
    return clouds


def _posture(stretch: MarsStretch) -> np.ndarray:
    """Joints and, weighted by a third of a second, their velocities (sample, 132)."""
    joints_m = smoothed(stretch.joints_m)
    velocity_mps = np.gradient(joints_m, stretch.frame * FRAME_S, axis=0)
    both = np.concatenate([joints_m, VELOCITY_WEIGHT_S * velocity_mps], axis=1)
    return both.reshape(len(both), -1)


def _points(place_m: np.ndarray) -> PointCloud:
    none = np.full(len(place_m), np.nan)
    return PointCloud(
        frame=np.zeros(len(place_m), int), x_m=place_m[:, 0], y_m=place_m[:, 1], z_m=place_m[:, 2],
        radial_velocity_mps=none, snr_db=none,
    )  # fmt: skip


# the study ----------------------------------------------------------------------------------------------------------
def measure(data: Path, run: StudyRun, split: str, report: Callable[[str], object] = print) -> dict[str, CloudScores]:
    """Estimates on `validate`, scores pieces of the split that estimated nothing, writes results; returns the scores.

    All of `validate`, a part of `test` spread evenly.
    """
    began, validate = time.perf_counter(), read_mars(data, "validate")
    used = cut(validate, PIECE_FRAMES, PIECES_TO_ESTIMATE)
    setup = calibrate(used, report)
    taken = {id(piece.clouds[0]) for piece in used}
    stretches = validate if split == "validate" else read_mars(data, split)
    pieces = cut(stretches, PIECE_FRAMES, MOST_PIECES if split == "validate" else PIECES)
    pieces = [piece for piece in pieces if id(piece.clouds[0]) not in taken]
    real: Clouds = [piece.clouds for piece in pieces]
    mean = round(np.mean([len(cloud.x_m) for stretch in validate for cloud in stretch.clouds]))
    methods: dict[str, Callable[[], Clouds]] = {
        "baseline_centroid": partial(centroid_baseline, pieces, setup),
        "baseline_random_on_body": partial(surface_baseline, pieces, setup, mean),
        "baseline_random_real_frame": partial(random_frame_baseline, pieces, validate),
        "oracle_neighbouring_frame": partial(neighbour_oracle, pieces),
        "oracle_same_pose_again": partial(same_pose_oracle, pieces, stretches),
        "simulator": partial(_simulated, pieces, setup),
    }
    if split == "validate":
        del methods["baseline_random_real_frame"]  # of the same recordings
    scores: dict[str, CloudScores] = {}
    for name, method in methods.items():
        scores[name] = score(method(), real)
        report(f"{name:28s} {scores[name].line()}")
        _write(run, name, setup, data, scores, seconds=time.perf_counter() - began, split=split)
    return scores


def mars_digests(data: Path, split: str = "test") -> dict[str, str]:
    """The sha256 of each file of a split."""
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(data.glob(f"*_{split}.csv"))}


def _simulated(pieces: list[MarsStretch], setup: Setup) -> Clouds:
    return detect(simulate(pieces, setup), pieces, setup)


def _write(
    run: StudyRun, name: str, setup: Setup, data: Path, scores: dict[str, CloudScores], *, seconds: float,
    split: str,
) -> None:  # fmt: skip
    row: dict[str, Any] = {
        "dataset": {"name": f"MARS subject 1, {split}", "sha256": mars_digests(data, split)},
        "n": scores[name].num_frames,
        "seeds": [0],
        "seconds": {"all": round(seconds, 1)},
        "metrics": scores[name].metrics(floor=scores["baseline_centroid"]),
    }
    config = {"estimated_on_validate": asdict(setup), "frames_a_piece": PIECE_FRAMES}
    run.write("mars" if split == "test" else f"mars_{split}", name, config=config, rows=complete_rows([row]))


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder of a MARS subject")
    parser.add_argument("--split", choices=("test", "validate"), default="test", help="what is scored (default: test)")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(options.data, run, options.split)
