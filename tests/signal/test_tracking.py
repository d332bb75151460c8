"""Clusters are people, and tracks follow them."""

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.signal.tracking import cluster_points, dbscan, track_people

PERIOD_S = 0.1


def walking(paths, num_frames: int = 30, noise: int = 3) -> PointCloud:
    """Eight points about each path (time -> x, y), and some anywhere."""
    rng = np.random.default_rng(0)
    rows = []
    for frame in range(num_frames):
        for path in paths:
            middle = np.array([*path(frame * PERIOD_S), 0.0])
            later = np.array([*path(frame * PERIOD_S + 1e-3), 0.0])
            radial = (np.linalg.norm(later) - np.linalg.norm(middle)) / 1e-3
            rows += [(frame, *(middle + rng.normal(0, 0.12, 3)), radial + rng.normal(0, 0.1)) for _ in range(8)]
        rows += [(frame, *rng.uniform((-3, 0.5, -1), (3, 6, 1)), rng.normal(0, 1)) for _ in range(noise)]
    table = np.array(rows)
    return PointCloud(
        frame=table[:, 0].astype(int), x_m=table[:, 1], y_m=table[:, 2], z_m=table[:, 3],
        radial_velocity_mps=table[:, 4], snr_db=np.full(len(table), 20.0),
    )  # fmt: skip


def test_two_people_who_cross_are_two_tracks():
    times = np.arange(30) * PERIOD_S
    paths = (lambda t: (-1.5 + t, 3.0), lambda t: (1.5 - t, 4.2))
    tracks = track_people(walking(paths), times)
    assert len(tracks) == 2
    for path in paths:
        errors = [
            np.linalg.norm(track.place_m - np.array([path(t) for t in track.time_s]), axis=1).mean() for track in tracks
        ]
        assert min(errors) < 0.1
        track = tracks[int(np.argmin(errors))]
        speed = (np.array(path(1.0)) - np.array(path(0.0)))[0]
        assert track.velocity_mps[-5:, 0].mean() == pytest.approx(speed, abs=0.25)
        assert len(track.frame) >= 28


def test_scattered_points_are_no_people():
    assert track_people(walking((), noise=6), np.arange(30) * PERIOD_S) == []
    empty = walking((lambda t: (0.0, 2.0),)).select(np.zeros(0, int))
    assert track_people(empty, np.arange(5) * PERIOD_S) == []
    assert len(cluster_points(empty)) == 0


def test_dbscan_agrees_with_scikit_learn():
    cluster = pytest.importorskip("sklearn.cluster")
    rng = np.random.default_rng(1)
    places = np.concatenate(
        [rng.normal((0, 0), 0.3, (40, 2)), rng.normal((3, 0), 0.3, (30, 2)), rng.uniform(-5, 5, (20, 2))]
    )
    ours = dbscan(places, distance=0.5, fewest=4)
    theirs = cluster.DBSCAN(eps=0.5, min_samples=4).fit_predict(places)
    assert np.array_equal(ours == -1, theirs == -1)
    cores = cluster.DBSCAN(eps=0.5, min_samples=4).fit(places).core_sample_indices_
    together = ours[cores][:, None] == ours[cores][None]
    assert np.array_equal(together, theirs[cores][:, None] == theirs[cores][None])
