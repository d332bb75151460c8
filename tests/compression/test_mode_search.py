import numpy as np
import pytest

from mmweaver.compression import mode_choice
from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.mmw_codec import compress_cube, values_of_bytes
from mmweaver.core.records import RadarCube
from tests.fields.echoes import crowd


def errors(cube: RadarCube, num_bytes: int, effort: str) -> tuple[float, float]:
    """Energies of the error in active cells and in all."""
    left = np.square(np.abs(values_of_bytes(compress_cube(cube, num_bytes=num_bytes, effort=effort)) - cube.values))
    return float(left[active_cells(cube.values)].sum()), float(left.sum())


@pytest.mark.parametrize("is_misled", [False, True])
@pytest.mark.parametrize(
    ("cube", "num_bytes"),
    [(crowd(), 900), (crowd(num_frames=1), 2500), (crowd(num_points=2, noise=2e-2), 2500), (crowd(noise=0.1), 900)],
    ids=["many points", "one frame", "few points", "noise"],
)
def test_full_effort_is_not_behind_fast(
    cube: RadarCube, num_bytes: int, is_misled: bool, monkeypatch: pytest.MonkeyPatch
):
    """Nor where scatterers are fitted badly and taken all the same."""
    if is_misled:
        monkeypatch.setattr(mode_choice, "FIT_OF_FEW_FRAMES", (1, 0, 1.0))
        monkeypatch.setattr(mode_choice, "CLEAR", 1e9)
    full, fast = (errors(cube, num_bytes, effort) for effort in ("full", "fast"))
    assert full[0] <= fast[0] * 1.0001
    assert full[0] * full[1] <= fast[0] * fast[1] * 1.0001
