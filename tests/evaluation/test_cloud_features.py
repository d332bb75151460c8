"""Counts and extents of a cloud that is known."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.evaluation.cloud_features import points_height, points_per_frame
from mmweaver.evaluation.finding import FEATURES
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence
from tests.evaluation.made_signals import RADAR, evidence, samples, still


def cloud() -> PointCloud:
    """11 points in frame 0, none in frame 1, 2 in frame 2."""
    x = np.concatenate([np.linspace(-1, 1, 11), [0, 0]]).astype(np.float32)
    frame = np.array([0] * 11 + [2, 2])
    speed = np.where(np.arange(13) < 5, 1.0, 0.0).astype(np.float32)
    return PointCloud(
        frame=frame, x_m=x, y_m=np.full(13, 2, np.float32), z_m=x / 2, radial_velocity_mps=speed,
        snr_db=np.full(13, 15, np.float32),
    )  # fmt: skip


def test_numbers_of_a_known_cloud():
    signal = replace(evidence(samples([still(2.0)], frames=3)).signal, points=cloud())
    seen = SignalEvidence(signal)
    found = {feature.name: feature.measure(seen).values for feature in FEATURES if feature.name.startswith("points")}
    assert found["points"].tolist() == [11, 0, 2]
    for name, expected in {
        "points_width": 1.8, "points_depth": 0.0, "points_height": 0.9, "points_snr": 15, "points_moving": 5 / 11,
    }.items():  # fmt: skip
        assert found[name][0] == pytest.approx(expected, abs=1e-6), name
        assert np.isnan(found[name][1:]).all()
    near = SignalEvidence(signal, points_m=(0.0, 2.01))
    assert found["points"][0] > points_per_frame(near).values[0] > 0


def test_a_flat_array_has_no_height():
    flat = replace(RADAR, tx_position_m=(RADAR.tx_position_m[0],), tx_order=(0,))
    with pytest.raises(CannotSeeError, match="elevation"):
        points_height(evidence(samples([still(2.0)], config=flat)))
