"""What moves all the time in one place is found where people walk elsewhere; whoever exercises in one place is not."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.constant_movers import constant_movers, left_out_line, places_m
from mmweaver.recognition.point_recording import PointRecording

FRAMES, RATE_HZ = 100, 10.0
FAN = (-1.1, 3.1)


def recording(*movers: tuple[np.ndarray, np.ndarray]) -> PointRecording:
    """Movers at (frame,) right and ahead of the radar, each with a point a frame."""
    x, y = (np.stack([mover[axis] for mover in movers], axis=1).ravel() for axis in (0, 1))
    frame = np.repeat(np.arange(FRAMES), len(movers))
    cloud = PointCloud(
        frame=frame, x_m=x, y_m=y, z_m=np.zeros(len(x)), radial_velocity_mps=np.full(len(x), 0.5),
        snr_db=np.full(len(x), np.nan),
    )  # fmt: skip
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=RATE_HZ)


def at(right_m: float, ahead_m: float) -> tuple[np.ndarray, np.ndarray]:
    return np.full(FRAMES, right_m), np.full(FRAMES, ahead_m)


def walker(number: int) -> tuple[np.ndarray, np.ndarray]:
    return np.full(FRAMES, 0.6 + 0.05 * number), 1 + np.linspace(0, 2.5, FRAMES)


def exerciser(number: int) -> tuple[np.ndarray, np.ndarray]:
    return at(0.4 * (number % 3), 1.6 + 0.3 * (number % 4))


def test_a_fan_is_found_and_nobody_else():
    recordings = [recording(at(*FAN), walker(one) if one < 4 else exerciser(one)) for one in range(12)]
    cells = constant_movers(recordings)
    assert len(cells) == 9
    (place,) = places_m(cells)
    assert np.hypot(place[0] - FAN[0], place[1] - FAN[1]) < 0.2
    assert "3.1 m ahead and 1.1 m to the left" in left_out_line(place)


def test_whoever_exercises_in_one_place_is_somebody():
    """Also where an echo or a fan moves along, people walk there before, or few pass behind."""
    assert not len(constant_movers([recording(at(0.1, 2.1), at(0.3, 4.1)) for _ in range(12)]))
    recordings = [recording(at(0.1, 2.1), walker(one)) if one < 1 else recording(at(0.1, 2.1)) for one in range(12)]
    assert not len(constant_movers(recordings))
    there = recording((np.full(FRAMES, 0.1), np.maximum(4.0 - 0.04 * np.arange(FRAMES), 2.1)))
    assert not len(constant_movers([there] * 12))


def test_what_stops_while_somebody_walks_may_be_that_person():
    recordings = [recording(walker(one)) if one < 1 else recording(at(*FAN)) for one in range(12)]
    assert not len(constant_movers(recordings))


def test_few_recordings_say_nothing():
    assert not len(constant_movers([recording(at(*FAN), walker(one)) for one in range(9)]))
    assert places_m(constant_movers([])) == []
