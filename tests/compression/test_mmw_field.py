from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression import optimiser
from mmweaver.compression.mmw_codec import compress_cube, read_cube
from mmweaver.compression.mmw_field import open_mmw
from mmweaver.compression.signal_field import finer_grid
from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid, RadarCube
from tests.compression.echoes import crowd, error_db


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, RadarCube]:
    path = tmp_path_factory.mktemp("mmw") / "a.mmw"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(optimiser, "MAX_FRAMES", 2)
        path.write_bytes(compress_cube(crowd(), num_bytes=5000))
    return path, read_cube(path)


def test_the_field_of_a_file_is_the_cube_of_the_file(written: tuple[Path, RadarCube]):
    path, cube = written
    field = open_mmw(path)
    assert error_db(field.cube().values, cube.values) < -90
    index = np.stack([np.random.default_rng(0).integers(0, size, 200) for size in cube.values.shape], axis=1)
    assert error_db(field.sample(index.astype(float)), cube.values[tuple(index.T)]) < -80
    assert field.num_values > 100


def test_finer_grids_contain_the_cells_and_stay_near_between_them(written: tuple[Path, RadarCube]):
    path, cube = written
    field = open_mmw(path)
    finer = field.on_grid(n_r=2.0, n_d=2.0)
    assert error_db(finer.values[:, ::2, ::2], cube.values) < -60
    grid = finer_grid(cube.grid, n_r=2.0)
    places = np.stack(np.meshgrid([1], np.arange(0, 47) / 2, [5], [3], indexing="ij"), -1).reshape(-1, 4)
    assert error_db(field.sample(places), field.values_on(replace(grid))[1, :47, 5, 3]) < -60


@pytest.mark.parametrize("num_loops", [1, 2, 3])
def test_frames_of_few_loops_are_a_field_too(num_loops: int, tmp_path: Path):
    config = replace(AWR1843, num_loops=num_loops, num_range_bins=8)
    grid = CubeGrid.of(config, 3)
    parts = np.random.default_rng(0).normal(size=(2, *grid.shape)).astype(np.float32)
    cube = RadarCube(values=parts[0] + 1j * parts[1], grid=grid, config=config, scale=1.0)
    (tmp_path / "a.mmw").write_bytes(compress_cube(cube, num_bytes=900))
    field, stored = open_mmw(tmp_path / "a.mmw"), read_cube(tmp_path / "a.mmw").values
    assert np.allclose(field.cube().values, stored, atol=1e-5)
    assert np.allclose(field.sample(np.array([[1.0, 2.0, num_loops - 1, 5.0]])), stored[1, 2, -1, 5], atol=1e-5)
