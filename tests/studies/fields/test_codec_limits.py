from dataclasses import replace

import numpy as np

from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from studies.fields.codec_limits import gaussian_bound
from tests.fields.echoes import SMALL


def test_white_noise_has_the_error_that_its_bits_allow():
    """R bits a complex number leave 2^-R of its power, but for the spread of measured powers."""
    config = replace(SMALL, num_loops=32)
    grid = CubeGrid.of(config, 1)
    draw = stream(0, "noise").normal(size=(2, *grid.shape))
    values = (draw[0] + 1j * draw[1]).astype(np.complex64)
    cube = RadarCube(values=values, grid=grid, config=config, scale=1.0)
    num_bytes = 3 * values.size // 8
    assert abs(gaussian_bound(cube, num_bytes)["nmse_db"] + 3 * 10 * np.log10(2)) < 0.6
