"""Parts of the peers' study: the fair gain."""

from dataclasses import replace

import numpy as np
import pytest

from tests.cubes import point_cube

pytest.importorskip("mitsuba")


def test_the_best_gain_is_found_whatever_the_scale():
    from studies.peers.peer_scores import with_best_gain

    truth = point_cube()
    found = with_best_gain(replace(truth, values=truth.values * np.complex64(1e-4)), truth)
    np.testing.assert_allclose(found.values, truth.values, rtol=1e-4)
