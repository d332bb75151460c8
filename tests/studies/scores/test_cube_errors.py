import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from studies.scores.cube_scores import cells_of, complex_ssim, nmse_db, peak_of, psnr_db, span_of
from tests.cubes import point_cube

TRUTH = point_cube().values
NOISE = stream(0, "prediction").standard_normal((*TRUTH.shape, 2)).view(np.complex128)[..., 0]
PREDICTION = (TRUTH + 0.05 * NOISE).astype(np.complex64)


def test_psnr_equals_scikit_image():
    from skimage.metrics import peak_signal_noise_ratio

    peak = peak_of(TRUTH)
    two = [np.stack([values.real, values.imag]).astype(np.float64) for values in (TRUTH, PREDICTION)]
    assert psnr_db(PREDICTION, TRUTH, peak=peak) == pytest.approx(
        peak_signal_noise_ratio(two[0], two[1], data_range=peak), abs=1e-6
    )


def test_complex_ssim_equals_scikit_image_map_by_map():
    from skimage.metrics import structural_similarity

    span, scores = span_of(TRUTH), []
    for part in (np.real, np.imag):
        for frame in range(TRUTH.shape[0]):
            for antenna in range(TRUTH.shape[3]):
                maps = (part(values)[frame, :, :, antenna].astype(np.float64) for values in (PREDICTION, TRUTH))
                _, full = structural_similarity(
                    *maps, data_range=span, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, full=True
                )
                scores.append(full.mean())
    assert complex_ssim(PREDICTION, TRUTH, data_range=span) == pytest.approx(np.mean(scores), abs=1e-6)


def test_nmse_equals_numpy_norms():
    where = cells_of(point_cube()).is_active
    p, t = PREDICTION[where].astype(np.complex128), TRUTH[where].astype(np.complex128)
    expected = 20 * np.log10(np.linalg.norm(p - t) / np.linalg.norm(t))
    assert nmse_db(PREDICTION, TRUTH, where) == pytest.approx(expected, abs=1e-6)
    assert nmse_db(PREDICTION, TRUTH) > nmse_db(PREDICTION, TRUTH, where)


def test_perfect_and_empty():
    assert nmse_db(TRUTH, TRUTH) == -np.inf
    assert nmse_db(0 * TRUTH, TRUTH) == pytest.approx(0)
    assert np.isnan(nmse_db(TRUTH, 0 * TRUTH))
    assert psnr_db(TRUTH, TRUTH, peak=1.0) == np.inf
    assert complex_ssim(TRUTH, TRUTH, data_range=1.0) == pytest.approx(1)


def test_ranges_are_those_of_i_and_q():
    values = np.array([1 - 3j, 2 + 1j])
    assert (peak_of(values), span_of(values)) == (3, 5)
    with pytest.raises(InputError, match="peak"):
        psnr_db(values, values, peak=0.0)
