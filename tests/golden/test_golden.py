"""Files of every version of every format are read to the bit by today's code."""

import hashlib
import zipfile
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.compression.mmw_codec import describe_mmw, read_cube
from mmweaver.core.checksums import SUMS_FILE
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.datasets.verification import verify
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.npz_files import read_points_npz, read_poses_npz, read_radar_npz
from mmweaver.models.weights import load_into
from tests.compression.echoes import crowd, error_db

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
    assert read_poses_npz(golden / "results" / "pose.npz")[0].joints_m.shape == (2, 22, 3)
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


KLT = "KLT of antennas, DCT of all bins, KLT of Doppler bins"
BEAMS = "beams, DCT of static bins"
# of each chunk: its mode, and its error in dB against the cube that was coded; by the code that wrote the files
MMW_CHUNKS = {
    1: [("scatterers", -28.19)],
    2: [("scatterers", -33.42), ("scatterers", -22.84), ("scatterers", -45.70)],
    3: [
        (f"scatterers + {BEAMS}", -38.74),
        (f"low rank + {KLT}", -22.65),
        (f"scatterers + noise + {BEAMS}", -38.80),
        (BEAMS, -49.50),
    ],
    4: [
        (f"scatterers + {BEAMS}", -43.24),
        (f"low rank + {KLT}", -18.98),
        (f"scatterers + noise + {BEAMS}", -43.30),
        (f"{BEAMS}, DCT of ranges", -43.31),
    ],
    5: [
        (f"scatterers + {BEAMS}", -33.46),
        (f"low rank + {KLT}", -25.77),
        (f"scatterers + noise + {BEAMS}", -33.46),
        (f"{BEAMS}, DCT of ranges", -30.64),
        (BEAMS, -34.55),
        ("noise", -22.15),
    ],
}


@pytest.mark.parametrize("version", MMW_CHUNKS)
def test_every_way_to_code_a_chunk_is_read(version: int):
    """Three frames a chunk, the same cube in all of them."""
    path = Path(__file__).with_name(f"version_{version}.mmw")
    facts = describe_mmw(path)
    assert facts["version"] == version
    assert [chunk["mode"] for chunk in facts["chunks"]] == [mode for mode, _ in MMW_CHUNKS[version]]
    values = read_cube(path).values
    errors = [error_db(values[first : first + 3], crowd().values) for first in range(0, len(values), 3)]
    assert errors == pytest.approx([error for _, error in MMW_CHUNKS[version]], abs=0.01)
