"""Photographed rooms compared with true ones."""

import pytest

from studies.network.photographed_room import evaluated


def test_a_photo_is_better_than_nothing_and_another_realization_better_still():
    scores = evaluated("lab", 30)
    ssim = {name: value["ra_ssim"] for name, value in scores.items()}
    assert ssim["zeros"] < 0.05 < ssim["photo"] < ssim["realization"] < 1.0
    assert ssim["photo"] <= ssim["photo, true specular reflectors"] + 0.02
    assert (
        scores["zeros"]["ra_difference_db"]
        > scores["photo"]["ra_difference_db"]
        > scores["realization"]["ra_difference_db"]
    )


@pytest.mark.slow  # the test above holds the rows; this one that a scan takes the place of the photo
def test_a_scan_is_better_than_a_photo():
    scores = evaluated("kitchen", 30, by="scan")
    assert scores["scan"]["ra_ssim"] > evaluated("kitchen", 30)["photo"]["ra_ssim"]
    assert {"scan, true materials", "scan, true edges"} < scores.keys()
