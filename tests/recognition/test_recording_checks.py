"""Recordings that cannot be of the radar and columns that a task names are noticed, and no others."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.recording_checks import contradictions
from tests.recognition.clouds import RADAR, recording_of, with_others

UNGROUPED = replace(RADAR, max_velocity_mps=1.0, groups_range=False, groups_velocity=False)
RATE_HZ, FRAMES = 10.0, 100


def walker(*, rate_hz: float = RATE_HZ) -> PointRecording:
    """Somebody who goes to and fro by a metre with four points, in front of a wall that is at rest."""
    time_s = np.arange(FRAMES) / rate_hz
    range_m, speed = 2.5 + 0.5 * np.sin(1.2 * time_s), 0.6 * np.cos(1.2 * time_s)
    rng = np.random.default_rng(1)
    body, still = np.repeat(np.arange(FRAMES), 4), np.zeros(2 * FRAMES)
    y = np.concatenate([range_m[body] + rng.normal(0, 0.05, len(body)), still + 4.0])
    velocity = np.concatenate([np.round((speed[body] + rng.normal(0, 0.1, len(body))) / 0.12) * 0.12, still])
    frame = np.concatenate([body, np.repeat(np.arange(FRAMES), 2)])
    return recording_of(frame, x_m=rng.normal(0, 0.1, len(frame)), y_m=y, velocity_mps=velocity)


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
    assert any(words in line for line in contradictions([WRONG[words]()], UNGROUPED))


def test_a_recording_that_fits_is_not_doubted():
    assert contradictions([walker()], UNGROUPED) == []


def test_static_points_are_doubted_where_the_radar_removes_them():
    at_rest = changed(radial_velocity_mps=np.where(np.arange(len(CLOUD.frame)) % 4, 0.0, CLOUD.radial_velocity_mps))
    assert any(
        "removes static clutter" in line for line in contradictions([at_rest], replace(UNGROUPED, removes_static=True))
    )


def test_neighbours_that_firmware_groups_are_doubted_and_so_is_that_there_are_none():
    grouping = replace(RADAR, max_velocity_mps=1.0)
    first = CLOUD.select(np.diff(CLOUD.frame, prepend=-1) > 0)
    behind = replace(first, y_m=first.y_m + UNGROUPED.range_step_m)
    faster = replace(first, radial_velocity_mps=first.radial_velocity_mps + UNGROUPED.velocity_step_mps)
    alone = with_others(replace(walker(), cloud=first), WALL)
    several = with_others(replace(walker(), cloud=first), behind, faster)
    said = contradictions([several], grouping)
    assert ["in range" in line for line in said] == [True, False]
    assert ["in velocity" in line for line in said] == [False, True]
    assert contradictions([alone], grouping) == []
    assert sum("grouped" in line for line in contradictions([alone], UNGROUPED)) == 2


def test_impossible_velocities_and_missing_frames_are_reported():
    velocity = np.tile([0.36, 0.36, 0.36, 11_666.0], 20)
    one = recording_of(np.arange(80), velocity_mps=velocity, num_frames=400, missing=np.arange(80, 400))
    found = contradictions([one, recording_of(np.arange(80), velocity_mps=0.36)], RADAR)
    assert any("20 points of 1 of 2 recordings" in line and "11,666 m/s" in line for line in found)
    assert any("320 of 480 frames" in line and "1 of 2 recordings" in line for line in found)
    assert contradictions([recording_of(np.arange(80), velocity_mps=0.36)], RADAR) == []
