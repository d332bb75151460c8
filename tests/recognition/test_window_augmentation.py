"""Augmented copies lose and gain points, reproducibly."""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.window_augmentation import WindowAugmentation, augmented

FRAMES = 60


def window() -> PointRecording:
    frame = np.repeat(np.arange(FRAMES), 4)
    velocity = np.tile([0.0, 0.0, 0.615, 1.845], FRAMES)
    distance_m = 2.0 + 0.005 * frame
    cloud = PointCloud(
        frame=frame, x_m=0.1 * np.ones(len(frame)), y_m=distance_m, z_m=np.zeros(len(frame)),
        radial_velocity_mps=velocity, snr_db=np.full(len(frame), 15.0),
    )  # fmt: skip
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=30.0, label="walk")


NOTHING = WindowAugmentation(
    least_moving=1.0, least_static=1.0, frames_lost=0.0, slow_to_static=0.0, most_objects=0, false_points=0.0,
    tilt_rad=0.0,
)  # fmt: skip


def test_with_zero_limits_only_time_and_sides_are_reversed():
    seen = set()
    for seed in range(12):
        cloud = augmented(window(), np.random.default_rng(seed), NOTHING).cloud
        backwards, mirrored = cloud.radial_velocity_mps.max() == 0, cloud.x_m.max() < 0
        seen.add((bool(backwards), bool(mirrored)))
        # what goes away, played backwards, comes nearer: range and velocity still agree
        slope = np.polyfit(cloud.frame, cloud.y_m, 1)[0]
        assert np.isclose(slope, -0.005 if backwards else 0.005)
        assert len(cloud.frame) == 4 * FRAMES
    assert len(seen) == 4


def test_points_are_dropped_and_added_within_limits():
    counts = []
    for seed in range(40):
        copy = augmented(window(), np.random.default_rng(seed))
        cloud = copy.cloud
        assert (np.diff(cloud.frame) >= 0).all()
        assert cloud.frame.min() >= 0
        assert cloud.frame.max() < FRAMES
        assert copy.label == "walk"
        counts.append(int((np.abs(cloud.radial_velocity_mps) > 1.5).sum()))
    assert min(counts) < 0.5 * FRAMES
    assert max(counts) > 0.9 * FRAMES


def test_added_objects_are_static_and_copies_follow_the_stream():
    objects = WindowAugmentation(most_objects=8, false_points=0.0, least_static=1.0)
    one, again = (augmented(window(), np.random.default_rng(3), objects).cloud for _ in range(2))
    assert np.array_equal(one.y_m, again.y_m)
    far = np.hypot(one.x_m, one.y_m) > 2.6
    assert far.any()
    assert (one.radial_velocity_mps[far] == 0).all()


def test_a_furnished_room_adds_static_cells_all_around():
    crowded = replace(NOTHING, crowded_share=1.0, most_crowded=30, reversed_share=0.0, reflected_share=0.0)
    added = []
    for seed in range(20):
        cloud = augmented(window(), np.random.default_rng(seed), crowded).cloud
        assert (np.abs(cloud.radial_velocity_mps) > 0).sum() == 2 * FRAMES  # nothing that moves is added
        assert (np.diff(cloud.frame) >= 0).all()
        added.append(len(cloud.frame) / FRAMES - 4)
    assert min(added) < 3
    assert max(added) > 15
