"""Paths of one frame are those of the signal: the same breath and sway, which follow from its seed."""

from typing import Any

import numpy as np
import pytest

from mmweaver import Weaver


@pytest.mark.parametrize("method", ["weaver", "physics"])
def test_paths_of_a_frame_breathe_as_the_signal_does(method: str):
    weaver = Weaver(method=method)
    room = weaver.sample_room()
    result = weaver.generate(room, "a person stands still", frames=6, seed=0)
    made: Any = weaver.method
    places_m = []
    for seed in (0, 0, 1):
        paths = made.paths(result.scene, result.motions, result.cube.config, frame=5, seed=seed, board=result.board)
        places_m.append(np.sort(np.asarray(paths.moving[0].departure.position_m).ravel()))
    assert np.array_equal(places_m[0], places_m[1])
    assert len(places_m[2]) != len(places_m[0]) or np.abs(places_m[2] - places_m[0]).max() > 1e-5
