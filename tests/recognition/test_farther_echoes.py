"""Echoes over walls are left out; a body with wide arms, who walks alone, and what is at rest stay."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.farther_echoes import without_farther
from mmweaver.recognition.point_recording import PointRecording

FRAMES, RATE_HZ = 20, 10.0


def group(right_m: float, ahead_m: np.ndarray | float, velocity_mps: float, points: int, seed: int = 0) -> np.ndarray:
    """Columns (point, 5) frame, x, y, z, velocity: so many points a frame within 0.2 m."""
    rng = np.random.default_rng(seed)
    frame = np.repeat(np.arange(FRAMES), points)
    ahead = np.broadcast_to(ahead_m, FRAMES)[frame]
    noise = rng.uniform(-0.1, 0.1, (3, len(frame)))
    return np.stack([frame, right_m + noise[0], ahead + noise[1], noise[2], np.full(len(frame), velocity_mps)], axis=1)


def recording(*groups: np.ndarray) -> PointRecording:
    rows = np.concatenate(groups)
    frame, x, y, z, velocity = rows[np.argsort(rows[:, 0], kind="stable")].T
    cloud = PointCloud(
        frame=frame.astype(int), x_m=x, y_m=y, z_m=z, radial_velocity_mps=velocity, snr_db=np.full(len(x), np.nan)
    )
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=RATE_HZ)


def test_an_echo_behind_the_person_is_left_out():
    person = group(0.0, 2.0, 0.5, 4)
    found = without_farther(recording(person, group(1.2, 2.8, 0.5, 2, 1))).cloud
    assert len(found.frame) == len(person)
    assert found.x_m.max() < 0.5


def test_of_many_points_behind_few_nothing_is_left_out():
    few, many = group(0.0, 2.0, 0.5, 1), group(1.2, 2.8, 0.5, 6, 1)
    assert len(without_farther(recording(few, many)).cloud.frame) == len(few) + len(many)


def test_what_is_at_rest_stays():
    person, box = group(0.0, 2.0, 0.5, 4), group(1.2, 4.0, 0.0, 2, 1)
    assert len(without_farther(recording(person, box)).cloud.frame) == len(person) + len(box)


def test_hands_at_either_side_of_a_body_stay():
    hands = group(-0.8, 2.0, 0.5, 2), group(0.8, 2.0, -0.5, 2, 1)
    one = recording(*hands, group(0.0, 2.0, 0.2, 2, 2))
    assert without_farther(one) is one


def test_who_runs_is_not_an_echo_of_where_they_were():
    one = recording(group(0.0, np.linspace(1.0, 7.0, FRAMES), 3.0, 4))
    assert without_farther(one) is one


def test_the_person_may_come_and_go_while_something_farther_moves():
    near, far = group(0.0, 2.0, 0.5, 3), group(1.5, 4.0, 0.5, 2, 1)
    near = near[near[:, 0] < FRAMES // 2]
    found = without_farther(recording(near, far)).cloud
    assert set(found.frame[found.y_m > 3.0]) == set(range(FRAMES // 2 + 1, FRAMES))
