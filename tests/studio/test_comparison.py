"""The numbers of the page are those of `mmweaver compare`."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.studio import sessions
from mmweaver.studio.service import comparison
from mmweaver.studio.sessions import Result, Session

NOTHING = PointCloud(
    frame=np.zeros(0, int), **{name: np.zeros(0) for name in ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")}
)


def noise(seed: int, factor: float = 1.0) -> Result:
    grid = CubeGrid.of(AWR1843, 8)
    rng = np.random.default_rng(seed)
    values = factor * (rng.standard_normal(grid.shape) + 1j * rng.standard_normal(grid.shape))
    cube = RadarCube(values=values.astype(np.complex64), grid=grid, config=AWR1843, scale=1e-6)
    return Result(cube=cube, points=NOTHING, poses=(), meta={"text": f"noise {seed}"})


def test_noise_ten_decibels_louder_is_said():
    found = comparison(noise(1), noise(2, 10**0.5))
    level = found["values"]["features"]["noise_level"]
    assert level["b"]["value"]["median"] - level["a"]["value"]["median"] == pytest.approx(10, abs=0.5)
    row = next(one for one in found["rows"] if "oise" in one["title"])
    assert row["gives_away"]
    assert "noise 1" in found["text"]


def test_points_alone_have_no_numbers():
    with pytest.raises(InputError, match=r"B .*point cloud"):
        comparison(noise(1), Result(cube=None, points=NOTHING, poses=(), meta={}))


def test_what_is_compared_with_stays(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sessions, "MAX_RESULTS", 3)
    session = Session()
    first = session.add(noise(0))
    session.pinned = first
    others = [session.add(noise(number)) for number in range(1, 5)]
    assert list(session.results) == [first, *others[-2:]]
    session.end()
