import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from studies.scores.cloud_distances import chamfer_m, cloud_distances_m, hausdorff_m

RNG = stream(0, "clouds")


def cloud(frame: list[int], places: np.ndarray) -> PointCloud:
    zeros = np.zeros(len(places))
    return PointCloud(
        frame=np.array(frame, int), x_m=places[:, 0], y_m=places[:, 1], z_m=places[:, 2],
        radial_velocity_mps=zeros, snr_db=zeros,
    )  # fmt: skip


def test_hausdorff_equals_scipy():
    from scipy.spatial.distance import directed_hausdorff

    one, other = RNG.random((30, 3)), RNG.random((20, 3))
    expected = max(directed_hausdorff(one, other)[0], directed_hausdorff(other, one)[0])
    assert hausdorff_m(one, other) == pytest.approx(expected)


def test_chamfer_equals_all_pairs():
    one, other = RNG.random((30, 3)), RNG.random((20, 3))
    distance = np.linalg.norm(one[:, None] - other[None], axis=-1)
    assert chamfer_m(one, other) == pytest.approx((distance.min(1).mean() + distance.min(0).mean()) / 2)


def test_frames_are_averaged_and_missing_clouds_count():
    origin, away = np.zeros((1, 3)), np.array([[3.0, 4.0, 0.0]])
    truth = cloud([0, 1], np.concatenate([origin, origin]))
    prediction = cloud([0], away)
    assert cloud_distances_m(prediction, truth, num_frames=3, missing_m=10.0) == pytest.approx((5.0, 5.0))
    assert cloud_distances_m(truth, truth, num_frames=3, missing_m=10.0) == (0.0, 0.0)
