from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression import mode_choice
from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.mmw_codec import compress_cube, scale_of, values_of_bytes
from mmweaver.compression.rate_search import within_bytes
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from tests.fields.echoes import SMALL, crowd


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


def test_noise_alone_is_coded_as_a_noise_layer():
    """The window correlates the noise of cells along Doppler: a transform holds it in fewer numbers than cells do."""
    config, num_frames = replace(SMALL, num_loops=32), 4
    shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
    draw = stream(0, "noise").normal(size=(2, *shape))
    window = np.hanning(config.num_loops)[:, None]
    values = np.fft.fftshift(np.fft.fft((draw[0] + 1j * draw[1]) * window, axis=2), axes=2).astype(np.complex64)
    cube = RadarCube(values=values, grid=CubeGrid.of(config, num_frames), config=config, scale=1.0)
    left = {}
    for without in ((), ("noise layer",)):
        segment = SegmentEncoder(cube, scale_of(cube), without=without)
        segment.plan_for(6000)
        chunks = [decode_chunk(data, config) for data in within_bytes(segment, 6000, lambda _: None)]
        again = np.concatenate([chunk.cube_values() for chunk in chunks])
        left[without] = float(np.sum(np.square(np.abs(again - values)))), chunks[0].mode_name()
    assert left[()][1] == "noise"
    assert left[()][0] < 0.9 * left[("noise layer",)][0]
