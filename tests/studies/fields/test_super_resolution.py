"""What the rivals score is known: zero padding is exact between bins, and adds no resolution."""

import json

import pytest

from studies.fields import super_resolution
from studies.manifest import StudyRun


@pytest.fixture(scope="module")
def rivals(tmp_path_factory) -> dict[str, dict[tuple[str, float], float]]:
    folder = tmp_path_factory.mktemp("results")
    scores = {}
    for path in super_resolution.measure(StudyRun("super_resolution", folder), (), factors=(2.0, 4.0)):
        rows = json.loads(path.read_text())["rows"]
        scores[path.stem] = {
            (row["dataset"]["truth"], row["dataset"]["factor"]): row["metrics"]["nmse_db"]["value"] for row in rows
        }
    return scores


def test_zero_padding_is_the_spectrum_between_the_bins(rivals):
    assert rivals["zero_padding"]["between_bins", 2.0] < -40
    assert rivals["zero_padding"]["sampled_places", 3.0] < -40


def test_straight_lines_need_phase_centring(rivals):
    assert rivals["linear_raw"]["between_bins", 2.0] > -1
    assert rivals["linear_centred"]["between_bins", 2.0] < -13


def test_no_sampling_of_a_coarse_radar_is_a_finer_radar(rivals):
    for name in ("zero_padding", "linear_centred"):
        for kind in ("more_bandwidth", "more_loops"):
            assert -5 < rivals[name][kind, 2.0] < 0
            assert rivals[name][kind, 4.0] > 0
        assert rivals[name]["more_antennas", 2.0] < -13


def test_scatterers_rendered_for_the_finer_radar_are_nearer_to_it_than_zero_padding(rivals):
    """Sampled more finely they end where zero padding ends, for the response stays the coarse radar's."""
    for kind in ("more_bandwidth", "more_loops"):
        padded = rivals["zero_padding"][kind, 2.0]
        assert abs(rivals["scatterers"][kind, 2.0] - padded) < 0.5
        assert rivals["scatterers_rendered"][kind, 2.0] < padded - 8
    assert rivals["scatterers"]["between_bins", 2.0] < -30
    assert rivals["scatterers_rendered"]["more_antennas", 2.0] < -30
