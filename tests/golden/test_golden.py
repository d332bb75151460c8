"""Files of every version of every format are read to the bit by today's code."""

import hashlib
import zipfile
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.compression.mmw_codec import read_cube
from mmweaver.core.checksums import SUMS_FILE
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.formats.dca1000 import read_bin
from mmweaver.formats.npz_files import read_points_npz, read_pose_npz, read_radar_npz
from mmweaver.models.weights import load_into
from mmweaver.verification import verify

# of the first cube and the joints of the data set, and of the cube of the result folder; by the code that wrote them
DIGESTS = {
    "0.1.0_plan_1": ("37ee0dfffc7e2794", "bed7b782bda3c310", "433816afcdb14cc7", 3.885328624164686e-06),
    "0.1.0": ("37ee0dfffc7e2794", "bed7b782bda3c310", "253be2b7aaf5a8d7", 2.1572141122305766e-06),
    "0.2.0": ("a1f921e639418e7b", "14380d178fdfacc9", "253be2b7aaf5a8d7", 2.1572141122305766e-06),
}


def digest(values: np.ndarray) -> str:
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()[:16]


@pytest.fixture(params=DIGESTS)
def version(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def golden(version: str, tmp_path: Path) -> Path:
    with zipfile.ZipFile(Path(__file__).with_name(f"{version}.zip")) as archive:
        archive.extractall(tmp_path)
    return tmp_path


def test_every_format_of_a_version_is_read(golden: Path, version: str):
    room_cube, joints, results_cube, mmw_power = DIGESTS[version]
    (room,) = read_rooms(golden / "dataset")
    assert digest(room.cube(0).values) == room_cube
    assert digest(room.joints_m) == joints
    assert room.text == ("a person raises the left hand",)
    cube = read_radar_npz(golden / "results" / "radar.npz")
    assert digest(cube.values) == results_cube
    assert read_pose_npz(golden / "results" / "pose.npz").joints_m.shape == (2, 22, 3)
    assert len(read_points_npz(golden / "results" / "points.npz").frame) > 0
    assert read_bin(golden / "results" / "adc_data.bin", cube.config).samples.shape == (2, 4, 1, 2, 64)
    power = float(np.sum(np.abs(read_cube(golden / "walk.mmw").values) ** 2))
    assert power == pytest.approx(mmw_power, rel=1e-5)
    layer = torch.nn.Linear(3, 2)
    card = load_into(layer, golden / "weights.safetensors", recipe="golden")
    torch.manual_seed(3)
    expected = torch.nn.Linear(3, 2).weight
    assert card.validation_loss == 1.5
    assert torch.allclose(layer.weight, expected, atol=1e-3)


def test_what_has_checksums_is_verified(golden: Path):
    found = verify(golden / "dataset")
    has_sums = (golden / "dataset" / SUMS_FILE).is_file()
    assert found.is_sound
    assert (found.checked > 30) == has_sums
    assert bool(found.unchecked) != has_sums
