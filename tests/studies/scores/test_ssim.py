import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from studies.scores.map_similarity import ssim_map


@pytest.mark.parametrize("data_range", [1.0, 50.0])
def test_it_equals_scikit_image(data_range: float):
    from skimage.metrics import structural_similarity

    rng = stream(0, "ssim")
    truth = data_range * rng.random((64, 32))
    prediction = truth + 0.2 * data_range * rng.standard_normal((64, 32))
    _, theirs = structural_similarity(
        prediction,
        truth,
        data_range=data_range,
        gaussian_weights=True,
        sigma=1.5,
        use_sample_covariance=False,
        full=True,
    )
    assert np.allclose(ssim_map(prediction, truth, data_range=data_range), theirs, atol=1e-10)


def test_a_stack_is_scored_map_by_map():
    rng = stream(1, "ssim")
    p, t = rng.random((2, 3, 8, 5)), rng.random((2, 3, 8, 5))
    whole = ssim_map(p, t, data_range=1.0)
    assert whole.shape == p.shape
    assert np.allclose(whole[1, 2], ssim_map(p[1, 2], t[1, 2], data_range=1.0))


def test_a_map_equals_itself():
    x = stream(2, "ssim").random((20, 20))
    assert np.allclose(ssim_map(x, x, data_range=1.0), 1)


def test_a_zero_data_range_is_refused():
    with pytest.raises(InputError, match=r"above 0, not 0\.0"):
        ssim_map(np.zeros((3, 3)), np.zeros((3, 3)), data_range=0.0)
