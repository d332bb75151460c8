"""Recordings that cannot be of the radar and columns that a task names are noticed, and no others."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.radar_facts import RadarFacts
from mmweaver.recognition.recording_checks import contradictions

FACTS = RadarFacts(
    range_step_m=0.05, velocity_step_mps=0.12, max_velocity_mps=1.0, removes_static=False, groups_range=False,
    groups_velocity=False, knows_place=False,
)  # fmt: skip
RATE_HZ, FRAMES = 10.0, 100


def walker(*, rate_hz: float = RATE_HZ) -> PointRecording:
    """Somebody who goes to and fro by a metre with four points, before a wall that is at rest."""
    time_s = np.arange(FRAMES) / rate_hz
    range_m, speed = 2.5 + 0.5 * np.sin(1.2 * time_s), 0.6 * np.cos(1.2 * time_s)
    rng = np.random.default_rng(1)
    body = np.repeat(np.arange(FRAMES), 4)
    frame = np.concatenate([body, np.repeat(np.arange(FRAMES), 2)])
    still = np.zeros(2 * FRAMES)
    y = np.concatenate([range_m[body] + rng.normal(0, 0.05, len(body)), still + 4.0])
    velocity = np.concatenate([np.round((speed[body] + rng.normal(0, 0.1, len(body))) / 0.12) * 0.12, still])
    order = np.argsort(frame, kind="stable")
    cloud = PointCloud(
        frame=frame[order], x_m=rng.normal(0, 0.1, len(frame)), y_m=y[order], z_m=np.zeros(len(frame)),
        radial_velocity_mps=velocity[order], snr_db=np.full(len(frame), np.nan),
    )  # fmt: skip
    return PointRecording(name="walk", cloud=cloud, num_frames=FRAMES, frame_rate_hz=RATE_HZ)


def joined(*clouds: PointCloud) -> PointCloud:
    """The points of both, in the order of frames."""
    columns = {name: np.concatenate([getattr(cloud, name) for cloud in clouds]) for name in vars(clouds[0])}
    order = np.argsort(columns["frame"], kind="stable")
    return PointCloud(**{name: column[order] for name, column in columns.items()})


def changed(**columns: np.ndarray) -> PointRecording:
    """The walker with other columns."""
    return replace(walker(), cloud=replace(walker().cloud, **columns))


CLOUD = walker().cloud
WALL = CLOUD.select(np.isclose(CLOUD.y_m, 4.0))
WRONG: dict[str, Callable[[], PointRecording]] = {
    "velocity_towards": lambda: changed(radial_velocity_mps=-CLOUD.radial_velocity_mps),
    "behind the radar": lambda: changed(x_m=CLOUD.y_m, y_m=CLOUD.x_m),
    "degrees or more aside": lambda: changed(x_m=CLOUD.y_m, y_m=np.abs(CLOUD.x_m)),
    "faster than 1.0 m/s": lambda: changed(radial_velocity_mps=2 * CLOUD.radial_velocity_mps),
    "no multiples of 0.12 m/s": lambda: changed(radial_velocity_mps=0.4 * CLOUD.radial_velocity_mps),
    "times as far as velocities say": lambda: walker(rate_hz=RATE_HZ / 2),
    "keeps static clutter": lambda: replace(walker(), cloud=CLOUD.select(np.abs(CLOUD.radial_velocity_mps) > 0.1)),
}


@pytest.mark.parametrize("words", WRONG)
def test_what_cannot_be_is_said(words: str):
    assert any(words in line for line in contradictions([WRONG[words]()], FACTS))


def test_a_recording_that_fits_is_not_doubted():
    assert contradictions([walker()], FACTS) == []


def test_static_points_are_doubted_where_the_radar_removes_them():
    at_rest = changed(radial_velocity_mps=np.where(np.arange(len(CLOUD.frame)) % 4, 0.0, CLOUD.radial_velocity_mps))
    assert any(
        "removes static clutter" in line for line in contradictions([at_rest], replace(FACTS, removes_static=True))
    )


def test_neighbours_that_firmware_groups_are_doubted_and_so_is_that_there_are_none():
    grouping = replace(FACTS, groups_range=True, groups_velocity=True)
    first = CLOUD.select(np.diff(CLOUD.frame, prepend=-1) > 0)
    behind = replace(first, y_m=first.y_m + FACTS.range_step_m)
    faster = replace(first, radial_velocity_mps=first.radial_velocity_mps + FACTS.velocity_step_mps)
    several, alone = (replace(walker(), cloud=cloud) for cloud in (joined(first, behind, faster), joined(first, WALL)))
    said = contradictions([several], grouping)
    assert ["in range" in line for line in said] == [True, False]
    assert ["in velocity" in line for line in said] == [False, True]
    assert contradictions([alone], grouping) == []
    assert sum("as if these were grouped" in line for line in contradictions([alone], FACTS)) == 2


def test_something_else_that_moves_asks_for_a_recording_of_the_empty_place():
    fan = PointCloud(
        frame=np.arange(FRAMES), x_m=np.full(FRAMES, 2.0), y_m=np.full(FRAMES, 3.0), z_m=np.zeros(FRAMES),
        radial_velocity_mps=np.full(FRAMES, 0.24), snr_db=np.full(FRAMES, np.nan),
    )  # fmt: skip
    with_fan = replace(walker(), cloud=joined(CLOUD, fan))
    assert any("record the empty place" in line for line in contradictions([with_fan], FACTS))
    assert not any("empty place" in line for line in contradictions([with_fan], replace(FACTS, knows_place=True)))


def test_too_few_points_tell_nothing():
    few = replace(walker(), cloud=CLOUD.select(np.arange(len(CLOUD.frame)) < 50))
    assert contradictions([few], FACTS) == []
    assert contradictions([], FACTS) == []


def test_facts_of_older_models_are_unknown():
    assert RadarFacts.read(FACTS.values()) == FACTS
    assert RadarFacts.read(None) is None
    assert RadarFacts.read({"velocity_step_mps": 0.1}) is None
    assert RadarFacts.read({**FACTS.values(), "velocity_step_mps": 0.0}) is None
