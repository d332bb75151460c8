"""Scores of point clouds: perfect for the same, poor for others, and what does not apply is missing."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.signal.firmware import FirmwareCloud
from studies.physics.cloud_scores import part_of, score


def cloud(num: int, seed: int, shift_m: float = 0.0, loud: float = 1.0, speed: float = 0.356) -> FirmwareCloud:
    rng = stream(seed, "cloud")
    return FirmwareCloud(
        frame=np.arange(num) // 5, x_m=0.2 * rng.standard_normal(num),
        y_m=1.8 + shift_m + 0.1 * rng.standard_normal(num),
        z_m=0.2 * rng.standard_normal(num), radial_velocity_mps=speed * rng.integers(-2, 3, num).astype(float),
        snr_db=np.full(num, 20.0), intensity=loud * (10 + 5 * rng.random(num)), noise_db=np.zeros(num),
        range_bin=np.zeros(num, int), doppler_bin=np.zeros(num, int),
    )  # fmt: skip


def pieces(shift_m: float = 0.0, loud: float = 1.0, speed: float = 0.356) -> list[tuple[FirmwareCloud, ...]]:
    return [tuple(cloud(20 + 3 * i + p, 10 * p + i, shift_m, loud, speed) for i in range(6)) for p in range(3)]


def test_the_same_is_perfect():
    scores = score(pieces(), pieces())
    for name in (
        "chamfer_m",
        "hausdorff_m",
        "centroid_m",
        "extent_m",
        "empty",
        "points_error",
        "doppler",
        "intensity_db",
    ):
        assert scores.value(name) == 0
    assert scores.value("points_correlation") == pytest.approx(1)
    assert scores.value("speed_correlation") == pytest.approx(1)
    assert scores.num_frames == 18
    assert scores.intervals["chamfer_m"] == (0, 0)


def test_each_fault_moves_its_own_score():
    scores = score(pieces(shift_m=0.5), pieces())
    assert scores.value("centroid_m") == pytest.approx(0.5, abs=1e-6)
    assert scores.value("extent_m") == pytest.approx(0, abs=1e-6)
    assert 0.3 < scores.value("chamfer_m") <= 0.5
    assert score(pieces(loud=2.0), pieces()).value("intensity_db") == pytest.approx(6.02, abs=0.01)
    assert 0.3 < score(pieces(speed=0.712), pieces()).value("doppler") < 0.7


def test_what_does_not_apply_is_missing_and_empty_frames_count():
    none = np.zeros(0)
    empty = FirmwareCloud(
        frame=np.zeros(0, int), x_m=none, y_m=none, z_m=none, radial_velocity_mps=none, snr_db=none, intensity=none,
        noise_db=none, range_bin=np.zeros(0, int), doppler_bin=np.zeros(0, int),
    )  # fmt: skip
    ours = [(empty, *piece[1:]) for piece in pieces()]
    scores = score(ours, pieces())
    assert scores.value("empty") == pytest.approx(1 / 6)
    nothing = score([(empty,) * 6] * 3, pieces())
    assert nothing.value("empty") == 1
    assert set(nothing.values) == {"empty", "points", "points_error"}
    held = scores.metrics(floor=nothing)
    assert held["chamfer_m"]["baseline"] is None
    assert held["empty"]["baseline"] == {"centroid": 1}


def test_parts_keep_their_kind():
    part = part_of(cloud(20, 0), 2)
    assert isinstance(part, FirmwareCloud)
    assert len(part.intensity) == 5
