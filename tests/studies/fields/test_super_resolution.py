"""What the baselines score is known: zero padding is exact between bins, and adds no resolution."""

import json

import pytest

from studies.fields import super_resolution
from studies.manifest import StudyRun

pytestmark = pytest.mark.slow  # test_finer_radar.py tests what is compared here


@pytest.fixture(scope="module")
def baselines(tmp_path_factory) -> dict[str, dict[tuple[str, float], float]]:
    folder = tmp_path_factory.mktemp("results")
    scores = {}
    for path in super_resolution.measure(StudyRun("super_resolution", folder), (), factors=(2.0, 4.0)):
        rows = json.loads(path.read_text())["rows"]
        scores[path.stem] = {
            (row["dataset"]["truth"], row["dataset"]["factor"]): row["metrics"]["nmse_db"]["value"] for row in rows
        }
    return scores


def test_zero_padding_is_the_spectrum_between_the_bins(baselines):
    assert baselines["zero_padding"]["between_bins", 2.0] < -40
    assert baselines["zero_padding"]["sampled_places", 3.0] < -40


def test_straight_lines_need_phase_centring(baselines):
    assert baselines["linear_raw"]["between_bins", 2.0] > -1
    assert baselines["linear_centred"]["between_bins", 2.0] < -13


def test_no_sampling_of_a_coarse_radar_is_a_finer_radar(baselines):
    for name in ("zero_padding", "linear_centred"):
        for kind in ("more_bandwidth", "more_loops"):
            assert -5 < baselines[name][kind, 2.0] < 0
            assert baselines[name][kind, 4.0] > 0
        assert baselines[name]["more_antennas", 2.0] < -13


def test_scatterers_rendered_for_the_finer_radar_are_nearer_to_it_than_zero_padding(baselines):
    """Sampled more finely they end where zero padding ends, for the response stays the coarse radar's."""
    for kind in ("more_bandwidth", "more_loops"):
        padded = baselines["zero_padding"][kind, 2.0]
        assert abs(baselines["scatterers"][kind, 2.0] - padded) < 0.5
        assert baselines["scatterers_rendered"][kind, 2.0] < padded - 8
    assert baselines["scatterers"]["between_bins", 2.0] < -30
    assert baselines["scatterers_rendered"]["more_antennas", 2.0] < -30
