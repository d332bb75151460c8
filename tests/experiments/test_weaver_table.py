"""The deciding table: what has collapsed is told, loudness is measured against the truth."""

from dataclasses import replace

import numpy as np
import pytest
from tests.cubes import point_cube

from mmweaver.core.presets import AWR1843
from mmweaver.experiments.tables import _loudness
from mmweaver.experiments.weaver_table import _row, energy_db


def test_energy_over_the_truths():
    truth = point_cube(AWR1843, num_frames=2)
    fainter = replace(truth, values=truth.values / np.float32(10))
    assert energy_db(truth, truth) == pytest.approx(0.0)
    assert energy_db(fainter, truth) == pytest.approx(-20.0, abs=1e-3)
    assert energy_db(replace(truth, values=0 * truth.values), truth) < -200


def test_a_row_whose_energy_is_gone_says_so():
    for energy, told in ((-35.0, "paper, collapsed: 35 dB too little energy"), (-1.0, "paper")):
        values = {"ra_ssim": np.array([0.1, 0.3]), "energy_db": np.array([energy, energy])}
        row = _row("paper", values, ["office_0", "office_1"], "test_room")
        assert row["metrics"]["energy_db"]["unit"] == "dB"
        assert _loudness(row) == told
