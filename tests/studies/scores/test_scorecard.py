"""Requirements for a headline metric; PSNR and cSSIM fail them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from studies.scores.scorecard import METRICS, Scorecard, scorecard
from tests.cubes import point_cube

HEADLINES = [name for name, metric in METRICS.items() if metric.is_headline]


def other_phases(cube: RadarCube) -> RadarCube:
    """The right magnitudes under a random phase per cell, the same for all its antennas: another realization."""
    phase = 2j * np.pi * stream(0, "twin").random(cube.values.shape[:3])
    return replace(cube, values=(cube.values * np.exp(phase)[..., None]).astype(np.complex64))


@pytest.fixture(scope="module")
def truth() -> RadarCube:
    return point_cube(AWR1843, num_frames=3, noise=0.2)


@pytest.fixture(scope="module")
def card(truth: RadarCube) -> Scorecard:
    return scorecard(truth, truth, oracle=other_phases(truth))


def test_the_ground_truth_scores_perfectly(card: Scorecard):
    for name, metric in METRICS.items():
        assert card.prediction[name] == pytest.approx(metric.perfect, abs=1e-6), name


@pytest.mark.parametrize("name", HEADLINES)
def test_all_zeros_score_poorly_on_every_headline(card: Scorecard, name: str):
    poor = {
        "dB": card.baselines["zeros"][name] >= (0.0 if "nmse" in name else 5.0),
        "1": card.baselines["zeros"][name] <= 0.2,
        "rad": card.baselines["zeros"][name] >= np.pi / 2 - 1e-9,
        "m": card.baselines["zeros"][name] >= 1.0,
    }
    assert poor[METRICS[name].unit], card.baselines["zeros"][name]


def test_psnr_and_cssim_are_saturated_by_zeros(card: Scorecard):
    """On a sparse cube the empty one has 0.9 and 30 dB (the paper: 0.88 and 35), and beats the right magnitudes."""
    zeros, oracle = card.baselines["zeros"], card.oracle
    assert oracle is not None
    assert zeros["psnr_db"] > 29
    assert zeros["cssim"] > 0.9
    for name in ("psnr_db", "cssim"):
        assert not METRICS[name].is_headline
        assert zeros[name] > oracle[name]
    for name in ("rd_ssim", "ra_ssim"):
        assert zeros[name] < oracle[name]
    for name in ("rd_difference_db", "ra_difference_db", "antenna_phase_error_rad", "chamfer_m", "hausdorff_m"):
        assert zeros[name] > oracle[name]


def test_more_noise_scores_worse_on_every_headline(truth: RadarCube):
    noise = stream(0, "noise").standard_normal((*truth.values.shape, 2)).view(np.complex128)[..., 0]
    cards = [
        scorecard(replace(truth, values=(truth.values + level * noise).astype(np.complex64)), truth).prediction
        for level in (1e-3, 1e-1)
    ]
    for name in HEADLINES:
        better = cards[0][name] > cards[1][name] if METRICS[name].unit == "1" else cards[0][name] < cards[1][name]
        assert better, name


def test_every_score_is_written_with_its_baselines_and_data_range(card: Scorecard):
    rows = card.as_json()
    json.dumps(rows, allow_nan=False)
    assert set(rows) == set(METRICS)
    for row in rows.values():
        assert set(row["baseline"]) == {"zeros", "static_mean"}
        assert "realization" in row["oracle"]
        assert {"value", "unit", "definition", "version"} <= set(row)
    assert rows["psnr_db"]["peak"] > 0
    assert rows["cssim"]["data_range"] > rows["psnr_db"]["peak"]
    assert rows["psnr_db"]["value"] is None


def test_what_cannot_be_scored_is_refused(truth: RadarCube):
    with pytest.raises(InputError, match=r"\(4, 32, 16, 12\).*\(3, 64, 32, 12\)"):
        scorecard(point_cube(), truth)
    with pytest.raises(InputError, match="all zeros"):
        scorecard(truth, replace(truth, values=0 * truth.values))
    broken = truth.values.copy()
    broken[0, 0, 0, 0] = np.nan
    with pytest.raises(InputError, match="not finite"):
        scorecard(replace(truth, values=broken), truth)
