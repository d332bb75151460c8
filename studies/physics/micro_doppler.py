"""Micro-Doppler of recorded people (CMU motion capture) and of the library's motions, through one simulator.

python -m studies run micro_doppler --mocap <folder with cmu_joints_m_120fps.npz> \\
    --picture docs/images/micro_doppler.png

Every recorded clip is paired with library motions of its gait, length, speed, leg length and skin; both pass the same
smoothing, and are simulated towards the radar and, rotated about the middle of their path, away from it. So only the
motion differs. The baseline is the recorded body moving along its path frozen in one pose: it has no micro-motion.
The radar is the awr1843 with one transmitter and one receiver, 256 chirps in 18.4 ms: 13.5 m/s unambiguous, steps of
0.105 m/s, 50 spectra a second.
"""

import argparse
import hashlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.presets import AWR1843
from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Joints
from mmweaver.core.skeleton import joint
from mmweaver.dsp.cube import radar_cube, remove_static
from mmweaver.dsp.spectra import range_doppler_power
from mmweaver.motion.animation.assemble import assemble
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_resampling import resampled_clip
from mmweaver.motion.mocap.joint_arrays import clips_of
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.static_paths import ALL_PATHS
from studies.manifest import StudyRun
from studies.motion.motion_realism import LEAP_M, RATE_HZ, SPEEDS, cadence_hz, is_steady, speed_of
from studies.physics.empty_room_cube import empty_room
from studies.physics.micro_doppler_measures import (
    DEFINITIONS,
    STEP_S,
    Figures,
    Spectrogram,
    both_ways,
    gait_figures,
    kinematic_figures,
    spread_figures,
)
from studies.result_rows import complete_rows
from studies.study import Reads

Array = np.ndarray

EXPERIMENT = "micro_doppler"
VERSION = 2  # 2: bodies as long in the leg as the recorded ones, not as tall
FILE = "cmu_joints_m_120fps.npz"
RADAR = replace(
    AWR1843,
    name="awr1843, one transmitter and receiver, 256 loops",
    tx_position_m=AWR1843.tx_position_m[:1],
    rx_position_m=AWR1843.rx_position_m[:1],
    tx_order=(0,),
    num_loops=256,
    frame_period_s=0.02,
    first_range_bin=8,
    num_range_bins=200,
)
RADAR_HEIGHT_M = 1.0
NEAREST_M = 2.0
LONGEST_S = 3.0
JUMP_S = 1.6  # shown about the top of a jump
GATE_M = 1.0  # range bins so near the pelvis are summed
NOISE_FROM_MPS = 11.0
NOISE_FACTOR = 5.0  # cells that do not pass the noise by so much are set to zero
MOST_CLIPS = 25
LIBRARY_EACH = {"walking": 1, "running": 4, "jumping": 4}
ACTIVITIES = tuple(LIBRARY_EACH)
RIGID = 6  # clips of each gait that are also shown frozen
RESAMPLES = 1000
REFERENCE_M = 1.75


@dataclass(frozen=True, kw_only=True)
class RecordedMotion:
    """Joints of a body at RATE_HZ, z up, with a label."""

    joints_m: Joints
    height_m: float
    subject: int
    label: str


# Motions -------------------------------------------------------------------------------------------------------------
def recorded(path: Path, activity: str, most: int = MOST_CLIPS) -> list[RecordedMotion]:
    """The steady, straight clips of a gait, or a window about the highest jump of each; evenly thinned to `most`."""
    found = []
    for name in clips_of(path):
        if f"/{activity}" not in name:
            continue
        clip = read_motion(path, clip=name)
        if activity in SPEEDS and not is_steady(clip.joints_m[:, 0], SPEEDS[activity]):
            continue
        joints = about_the_top(clip.joints_m) if activity == "jumping" else _middle(clip.joints_m)
        found.append(RecordedMotion(joints_m=joints, height_m=clip.height_m, subject=len(found), label=name))
    kept = np.unique(np.linspace(0, len(found) - 1, min(most, len(found))).round().astype(int))
    return [found[k] for k in kept]


def library(like: RecordedMotion, activity: str, seed: int) -> RecordedMotion:
    """A generated motion of the gait, length, speed and body of the recorded one."""
    seconds = len(like.joints_m) / RATE_HZ
    moves: tuple[Move, ...] = ()
    step = Step(lower="walk" if activity == "walking" else "jog", end_s=seconds)
    length_m = speed_of({"pelvis": like.joints_m[:, 0]}) * seconds
    if activity == "jumping":
        seconds = 2.4
        step = Step(lower="leap" if seed % 2 else "jump", end_s=seconds, count=1)
        length_m = LEAP_M if seed % 2 else 0.0
    if length_m:
        moves = (
            Move(
                start_s=0.0, end_s=seconds, length_m=length_m, direction_rad=0.0, ramp_in_s=0.0, ramp_out_s=0.0
            ),
        )  # fmt: skip
    pose = assemble(
        (PlacedStep(step=step, moves=moves),), RootPath(start_m=(0.0, 0.0), heading_rad=0.0, moves=moves),
        body_of(like), seed=seed, duration_s=seconds, floor_z_m=0.0,
    )  # fmt: skip
    inside = (pose.time_s >= -1e-9) & (pose.time_s < seconds - 1e-9)
    joints = pose.joints_m[inside]
    joints = about_the_top(joints) if activity == "jumping" else joints
    return replace(like, joints_m=joints, label=f"{activity}, seed {seed}")


def body_of(like: RecordedMotion) -> SkeletonProportions:
    """A library body with the same leg length: steps follow the legs. (The recordings have short trunks.)"""
    legs = [
        np.linalg.norm(like.joints_m[:, joint(f"{side}_{start}")] - like.joints_m[:, joint(f"{side}_{end}")], axis=1)
        for side in ("left", "right")
        for start, end in (("hip", "knee"), ("knee", "ankle"))
    ]
    leg_m = float(np.mean(np.sum(legs, axis=0))) / 2
    return SkeletonProportions(leg_m / SkeletonProportions(REFERENCE_M).leg_m * REFERENCE_M)


def frozen(motion: RecordedMotion) -> RecordedMotion:
    """The body in its middle pose, moved along its path at constant speed; joints (shown, 22, 3) in metres."""
    joints, pelvis = motion.joints_m, motion.joints_m[:, 0]
    part = np.linspace(0, 1, len(joints))[:, None]
    path_m = pelvis[0] + part * (pelvis[-1] - pelvis[0])
    path_m[:, 2] = pelvis[len(joints) // 2, 2]
    pose = joints[len(joints) // 2] - pelvis[len(joints) // 2]
    return replace(motion, joints_m=path_m[:, None] + pose, label=f"{motion.label}, frozen")


def _middle(joints_m: Joints) -> Float[Array, "shown 22 3"]:
    frames = min(round(LONGEST_S * RATE_HZ), len(joints_m))
    first = (len(joints_m) - frames) // 2
    return joints_m[first : first + frames]


def about_the_top(joints_m: Joints) -> Float[Array, "shown 22 3"]:
    """A window of JUMP_S around the highest position of the lower foot."""
    toes = joints_m[:, [joint("left_foot"), joint("right_foot")], 2].min(axis=1)
    frames = min(round(JUMP_S * RATE_HZ), len(joints_m))
    first = int(np.clip(int(toes.argmax()) - frames // 2, 0, len(joints_m) - frames))
    return joints_m[first : first + frames]


# Simulation ----------------------------------------------------------------------------------------------------------
def placed(joints_m: Joints, *, is_away: bool) -> Joints:
    """The motion on the radar's line of sight: towards it, or rotated by half a turn about the middle of its path.

    Ahead is where the pelvis goes, or where the hips face if it goes less than 1 m.
    """
    path_m = joints_m[-1, 0, :2] - joints_m[0, 0, :2]
    if np.linalg.norm(path_m) < 1.0:
        across = (joints_m[:, joint("left_hip")] - joints_m[:, joint("right_hip")]).mean(axis=0)
        path_m = np.array([across[1], -across[0]])
    turn = (np.pi / 2 if is_away else -np.pi / 2) - np.arctan2(path_m[1], path_m[0])
    about = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    result = joints_m.copy()
    result[..., :2] = result[..., :2] @ about.T
    pelvis = result[:, 0]
    low = float(np.percentile(result[..., 2].min(axis=1), 1))
    middle = (pelvis.min(axis=0) + pelvis.max(axis=0)) / 2
    result -= np.array([middle[0], pelvis[:, 1].min() - NEAREST_M, low - 0.04 + RADAR_HEIGHT_M])
    return result


def spectrogram(motion: RecordedMotion, simulator: Simulator, seed: int, *, is_away: bool) -> Spectrogram:
    """Power of the person over time and velocity from the cube, without static clutter and noise, near the pelvis.

    Velocities are signed along the person's path (ahead positive), and each frame sums to one.
    """
    clip = MotionClip(joints_m=placed(motion.joints_m, is_away=is_away), fps=RATE_HZ, label=motion.label)
    frames = int(np.floor((clip.duration_s - RADAR.active_time_s) / RADAR.frame_period_s))
    time_s, joints_m = resampled_clip(clip, clip.duration_s)
    pose = PoseSequence(time_s=time_s, joints_m=joints_m, height_m=motion.height_m, subject=motion.subject)
    power = []
    for chunk in simulator.chunks(pose, num_frames=frames, seed=seed):
        power.append(range_doppler_power(remove_static(radar_cube(chunk))))
    frame_s = np.arange(frames) * RADAR.frame_period_s + RADAR.active_time_s / 2
    distance_m = np.linalg.norm(joints_m[:, 0], axis=1)
    pelvis_m = np.interp(frame_s, time_s, distance_m)
    pelvis_mps = np.interp(frame_s, time_s, np.gradient(distance_m, time_s))
    near = np.abs(RADAR.range_m - pelvis_m[:, None]) < GATE_M
    summed = np.einsum("frd,fr->fd", np.concatenate(power), near.astype(float))
    noise = np.median(summed[:, np.abs(RADAR.radial_velocity_mps) > NOISE_FROM_MPS], axis=1, keepdims=True)
    # Steps, not a mere difference: what is left of noise in hundreds of cells would widen every percentile.
    echo = np.where(summed > NOISE_FACTOR * noise, summed - noise, 0.0)
    echo /= np.maximum(echo.sum(axis=1, keepdims=True), np.finfo(float).tiny)
    ahead = 1.0 if is_away else -1.0
    order = slice(None) if is_away else slice(None, None, -1)
    return Spectrogram(
        time_s=frame_s, velocity_mps=ahead * RADAR.radial_velocity_mps[order], share=echo[:, order],
        pelvis_mps=ahead * pelvis_mps,
    )  # fmt: skip


def simulator() -> Simulator:
    """RADAR 1 m above a concrete floor, in a room without walls."""
    return Simulator(empty_room(floor_z_m=-RADAR_HEIGHT_M), RADAR, propagation=ALL_PATHS)


def figures(motion: RecordedMotion, activity: str, shown_by: Simulator, seed: int) -> tuple[Figures, Spectrogram]:
    """All figures of one motion, and its spectrogram towards the radar."""
    towards, away = (spectrogram(motion, shown_by, seed, is_away=is_away) for is_away in (False, True))
    if activity == "jumping":
        return both_ways(towards, away, spread_figures), towards
    found = both_ways(towards, away, lambda seen: gait_figures(seen, STEP_S[activity]))
    joints = {name: motion.joints_m[:, joint(name)] for name in ("pelvis", "left_ankle", "right_ankle")}
    found["cadence_ratio"] = found["cadence_hz"] / cadence_hz(joints)
    return {**found, **kinematic_figures(motion.joints_m, RATE_HZ)}, towards


UNKNOWN = {"seconds": "see the manifest: all rows together"}


# Results -------------------------------------------------------------------------------------------------------------
def summary(found: list[Figures], rigid: list[Figures], recordings: list[Figures] | None) -> dict[str, dict[str, Any]]:
    """Median, interval and percentiles of each figure over clips; for generated clips also whether it is inside."""
    rows = {}
    for name in found[0]:
        values = np.array([one[name] for one in found])
        unit, definition = DEFINITIONS[name]
        row = {
            "value": _rounded(np.median(values)),
            "interval_95": [_rounded(edge) for edge in _interval(values)],
            "percentiles_5_95": [_rounded(edge) for edge in np.percentile(values, (5, 95))],
            "unit": unit,
            "definition": definition,
            "version": VERSION,
            "baseline": {"frozen": _rounded(np.median([one[name] for one in rigid]))} if name in rigid[0] else None,
        }
        if recordings:
            low, middle, high = np.percentile([one[name] for one in recordings], (5, 50, 95))
            row["recorded_5_50_95"] = [_rounded(edge) for edge in (low, middle, high)]
            row["inside"] = bool(low <= np.median(values) <= high)
            row["share_inside"] = _rounded(np.mean((values >= low) & (values <= high)))
        rows[name] = row
    return rows


def _rounded(value: Any) -> float:
    return round(float(value), 4)


def _interval(values: Float[Array, " clip"]) -> tuple[float, float]:
    """95 % of the median, bootstrap over clips."""
    draws = stream(0, "bootstrap").integers(len(values), size=(RESAMPLES, len(values)))
    low, high = np.percentile(np.median(values[draws], axis=1), (2.5, 97.5))
    return float(low), float(high)


def measure(run: StudyRun, folder: Path, picture: Path | None = None, most: int = MOST_CLIPS) -> tuple[Path, Path]:
    """Writes recorded.json and library.json, one row a gait, and a picture if asked for."""
    path = folder / FILE
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    shown_by, theirs_rows, our_rows, shown = simulator(), [], [], {}
    for activity in ACTIVITIES:
        clips, each = recorded(path, activity, most), LIBRARY_EACH[activity]
        made = [library(clip, activity, len(clips) * n + k) for n in range(each) for k, clip in enumerate(clips)]
        theirs = [figures(clip, activity, shown_by, k) for k, clip in enumerate(clips)]
        ours = [figures(motion, activity, shown_by, k) for k, motion in enumerate(made)]
        rigid = [spread_of_frozen(clip, shown_by, k) for k, clip in enumerate(clips[:RIGID])]
        dataset = {"name": f"CMU {activity}", "sha256": digest, "split": "its mean joint angles shaped the library"}
        real = [one for one, _ in theirs]
        theirs_rows.append(
            {"dataset": dataset, "n": len(clips), "clips": [clip.label for clip in clips], "seeds": [0, len(clips) - 1],
             "metrics": summary(real, rigid, None)}
        )  # fmt: skip
        our_rows.append(
            {"dataset": dataset, "n": len(made), "seeds": [0, len(made) - 1],
             "metrics": summary([one for one, _ in ours], rigid, real)}
        )  # fmt: skip
        chosen = _typical([one for one, _ in theirs])
        shown[activity] = (theirs[chosen][1], ours[chosen][1])
    if picture:
        from studies.physics.micro_doppler_picture import draw

        draw(shown, picture)
    config = {
        "radar": RADAR.name, "room": "concrete floor 1 m below the radar", "nearest_m": NEAREST_M,
        "longest_s": LONGEST_S, "jump_s": JUMP_S, "gate_m": GATE_M,
    }  # fmt: skip
    first = run.write(EXPERIMENT, "recorded", config=config, rows=complete_rows(theirs_rows, unknown=UNKNOWN))
    return first, run.write(EXPERIMENT, "library", config=config, rows=complete_rows(our_rows, unknown=UNKNOWN))


def spread_of_frozen(motion: RecordedMotion, shown_by: Simulator, seed: int) -> Figures:
    """The figures without rhythm of the body that does not move its limbs; it has none ahead or behind."""
    found, _ = figures(frozen(motion), "jumping", shown_by, seed)
    return {name: value for name, value in found.items() if name != "ahead_share"}


def _typical(found: list[Figures]) -> int:
    """The clip whose spread is nearest the median."""
    spread = np.array([one["spread_mps"] for one in found])
    return int(np.abs(spread - np.median(spread)).argmin())


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mocap", type=Path, action=Reads, required=True, help=f"folder with {FILE}")
    parser.add_argument("--picture", type=Path, help="a .png of spectrograms, recorded above and library below")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run, options.mocap, options.picture)
