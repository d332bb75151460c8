import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.evaluation.map_scores import log_map_difference_db, shown_db
from studies.scores.map_similarity import log_map_ssim

TRUTH = 10 ** (-8 * stream(0, "map").random((3, 20, 16)))


def test_the_difference_is_that_of_the_displays():
    prediction = TRUTH * 10 ** (0.3 * stream(1, "map").standard_normal(TRUTH.shape))
    top = TRUTH.max()
    pictures = [np.clip(10 * np.log10(power / top), -50, None) for power in (prediction, TRUTH)]
    expected = np.abs(pictures[0] - pictures[1]).sum() / (pictures[1] > -50).sum()
    assert log_map_difference_db(prediction, TRUTH) == pytest.approx(expected, rel=1e-9)


def test_the_ssim_equals_scikit_image_over_shown_cells():
    from skimage.metrics import structural_similarity

    prediction = TRUTH * 10 ** (0.3 * stream(1, "map").standard_normal(TRUTH.shape))
    p, t = (shown_db(power, float(TRUTH.max())) for power in (prediction, TRUTH))
    full = [
        structural_similarity(
            a, b, data_range=50.0, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, full=True
        )[1]
        for a, b in zip(p, t, strict=True)
    ]
    assert log_map_ssim(prediction, TRUTH) == pytest.approx(np.array(full)[(p > 0) | (t > 0)].mean(), abs=1e-9)


def test_scale_counts_and_faint_cells_do_not():
    assert log_map_difference_db(TRUTH * 2, TRUTH) == pytest.approx(10 * np.log10(2), abs=0.4)
    unseen = 1e-6 * float(TRUTH.max())
    faint = np.where(unseen > TRUTH, TRUTH / 100, TRUTH)
    assert log_map_difference_db(faint, TRUTH) == 0
    assert log_map_ssim(TRUTH, TRUTH) == pytest.approx(1)


def test_an_empty_map_is_far_from_others_and_no_ground_truth():
    assert log_map_ssim(0 * TRUTH, TRUTH) < 0.2
    with pytest.raises(InputError, match="zero everywhere"):
        log_map_ssim(TRUTH, 0 * TRUTH)
