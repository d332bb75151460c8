"""Tracking of people: clusters of moving points, followed by one Kalman filter each.

The state is position and velocity on the floor plane; a measurement is the median position of a cluster. Clusters
and tracks are assigned by least total distance (Hungarian method) within a gate. A track counts once it has been
observed in several frames, and ends when it has not been observed for a while, so a person who stops is lost.
Reference: Blackman and Popoli, "Design and Analysis of Modern Tracking Systems", 1999, ch. 3 and 6.

Clustering of the points of a frame by DBSCAN on position and radial velocity.

Reference: Ester et al., "A density-based algorithm for discovering clusters", KDD 1996.
"""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from mmweaver.core.records import PointCloud
from mmweaver.core.shapes import PerFrame

NOISE = -1


def dbscan(places: Float[np.ndarray, "point axis"], *, distance: float, fewest: int = 3) -> Int[np.ndarray, " point"]:
    """Density-based clustering.

    A point with at least `fewest` points within `distance`, itself included, is a core. Cores within reach of each
    other form one cluster; other points belong to the cluster of their nearest core within reach.

    Args:
        places: Coordinates (point, axis).
        distance: Reach, in the unit of the coordinates.
        fewest: Minimum number of points within reach of a core.

    Returns:
        Cluster (point,) of each point, from 0; -1 for noise.

    >>> dbscan(np.array([[0.0], [0.1], [0.2], [5.0]]), distance=0.3, fewest=2).tolist()
    [0, 0, 0, -1]
    """
    count = len(places)
    labels = np.full(count, NOISE)
    if not count:
        return labels
    tree = KDTree(places)
    pairs = tree.query_pairs(distance, output_type="ndarray")
    neighbours = np.bincount(pairs.ravel(), minlength=count) + 1
    is_core = neighbours >= fewest
    linked = pairs[is_core[pairs].all(axis=1)]
    graph = coo_array((np.ones(len(linked)), (linked[:, 0], linked[:, 1])), shape=(count, count))
    component = connected_components(graph, directed=False)[1]
    core = np.flatnonzero(is_core)
    if len(core):
        _, labels[core] = np.unique(component[core], return_inverse=True)
        near_m, nearest = KDTree(places[core]).query(places)
        border = ~is_core & (near_m <= distance)
        labels[border] = labels[core[nearest[border]]]
    return labels


REACH_M = 0.5  # between points of one person
VELOCITY_WEIGHT_S = 0.2  # distance in metres that corresponds to a difference of 1 m/s
MIN_POINTS = 4
GATE = 9.2  # 99 % of a chi-square with two degrees of freedom
PLACE_SD_M = 0.15
ACCELERATION_SD_MPS2 = 2.0
FIRST_VELOCITY_SD_MPS = 1.0
SEEN_FRAMES = 4  # minimum number of observations of a track
LOST_S = 0.7  # time without observations after which a track ends


@dataclass(frozen=True, kw_only=True)
class PersonTrack:
    """One person's smoothed path on the floor plane, from the first to the last observation."""

    frame: Int[np.ndarray, " step"]
    time_s: Float[np.ndarray, " step"]
    place_m: Float[np.ndarray, "step 2"]  # x right, y away
    velocity_mps: Float[np.ndarray, "step 2"]
    height_m: float  # median z of its points, relative to the radar
    num_points: int

    @property
    def mean_speed_mps(self) -> float:
        """Mean speed on the floor plane in m/s."""
        return float(np.linalg.norm(self.velocity_mps, axis=1).mean())


@dataclass(eq=False)
class _Track:
    state: np.ndarray
    covariance: np.ndarray
    steps: list[tuple[int, np.ndarray]] = field(default_factory=list)
    seen: list[int] = field(default_factory=list)
    heights: list[float] = field(default_factory=list)
    num_points: int = 0


def cluster_points(points: PointCloud) -> Int[np.ndarray, " point"]:
    """Clusters of points within each frame, by 3-D position and radial velocity.

    Args:
        points: Points of all frames.

    Returns:
        Cluster (point,) of each point, numbered per frame from 0; -1 for noise.
    """
    labels = np.full(len(points.frame), NOISE)
    where = np.stack([points.x_m, points.y_m, points.z_m, VELOCITY_WEIGHT_S * points.radial_velocity_mps], axis=1)
    for frame in np.unique(points.frame):
        own = points.frame == frame
        labels[own] = dbscan(where[own], distance=REACH_M, fewest=MIN_POINTS)
    return labels


def track_people(points: PointCloud, frame_time_s: PerFrame) -> list[PersonTrack]:
    """Tracks of people, the longest first.

    Args:
        points: Moving points (`point_cloud(..., moving_only=True)`).
        frame_time_s: Times (frame,) of all frames in seconds.
    """
    labels = cluster_points(points)
    tracks: list[_Track] = []
    done: list[_Track] = []
    for frame, time_s in enumerate(frame_time_s):
        step_s = float(time_s - frame_time_s[frame - 1]) if frame else 0.0
        for track in tracks:
            _predict(track, step_s)
        _assign(tracks, points, labels, frame)
        lost = [track for track in tracks if time_s - frame_time_s[track.seen[-1]] > LOST_S]
        done += lost
        tracks = [track for track in tracks if track not in lost]
        for track in tracks:
            track.steps.append((frame, track.state.copy()))
    found = [_finished(track, frame_time_s) for track in done + tracks if len(track.seen) >= SEEN_FRAMES]
    return sorted(found, key=lambda track: -len(track.frame))


def _predict(track: _Track, step_s: float) -> None:
    move = np.eye(4)
    move[0, 2] = move[1, 3] = step_s
    push = np.array([[step_s**2 / 2, 0], [0, step_s**2 / 2], [step_s, 0], [0, step_s]])
    track.state = move @ track.state
    track.covariance = move @ track.covariance @ move.T + ACCELERATION_SD_MPS2**2 * push @ push.T


def _assign(tracks: list[_Track], points: PointCloud, labels: np.ndarray, frame: int) -> None:
    """Updates tracks by the clusters of a frame, and starts new tracks."""
    own = points.frame == frame
    clusters = [own & (labels == label) for label in range(int(labels[own].max(initial=NOISE)) + 1)]
    places = [np.array([np.median(points.x_m[one]), np.median(points.y_m[one])]) for one in clusters]
    cost = np.array([[_gap(track, place) for place in places] for track in tracks]).reshape(len(tracks), len(places))
    taken = set()
    for row, column in zip(*linear_sum_assignment(np.minimum(cost, GATE + 1)), strict=True):
        if cost[row, column] <= GATE:
            _update(tracks[row], places[column])
            _note(tracks[row], points, clusters[column], frame)
            taken.add(int(column))
    for index, place in enumerate(places):
        if index not in taken:
            covariance = np.diag([PLACE_SD_M**2] * 2 + [FIRST_VELOCITY_SD_MPS**2] * 2)
            track = _Track(np.array([*place, 0.0, 0.0]), covariance)
            _note(track, points, clusters[index], frame)
            tracks.append(track)


def _gap(track: _Track, place: np.ndarray) -> float:
    """Squared Mahalanobis distance."""
    off = place - track.state[:2]
    return float(off @ np.linalg.solve(track.covariance[:2, :2] + PLACE_SD_M**2 * np.eye(2), off))


def _update(track: _Track, place: np.ndarray) -> None:
    gain = track.covariance[:, :2] @ np.linalg.inv(track.covariance[:2, :2] + PLACE_SD_M**2 * np.eye(2))
    track.state = track.state + gain @ (place - track.state[:2])
    track.covariance = track.covariance - gain @ track.covariance[:2]


def _note(track: _Track, points: PointCloud, which: np.ndarray, frame: int) -> None:
    track.seen.append(frame)
    track.heights.append(float(np.median(points.z_m[which])))
    track.num_points += int(which.sum())


def _finished(track: _Track, frame_time_s: np.ndarray) -> PersonTrack:
    steps = [(frame, state) for frame, state in track.steps if frame <= track.seen[-1]]
    frame, state = np.array([step[0] for step in steps]), np.array([step[1] for step in steps])
    return PersonTrack(
        frame=frame,
        time_s=np.asarray(frame_time_s)[frame],
        place_m=state[:, :2],
        velocity_mps=state[:, 2:],
        height_m=float(np.median(track.heights)),
        num_points=track.num_points,
    )
