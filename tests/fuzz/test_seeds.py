"""Every seed of the harness is a sound file: unmutated it is accepted, quickly and in little memory."""

from pathlib import Path

import pytest

from tests.fuzz import mutators
from tests.fuzz.harness import Reader, Report, try_case
from tests.fuzz.readers import make_readers

CHOICES = 24  # among the seeds of a reader
# seeds that are refused by design: the decoders of these formats are never reached, or nothing is damaged
REFUSED = {"colour picture": 5}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("seeds")


@pytest.fixture(scope="module")
def readers(folder: Path) -> list[Reader]:
    return make_readers(folder)


def test_every_seed_is_accepted_undamaged(readers: list[Reader], folder: Path):
    wrong = []
    for reader in readers:
        seeds = {reader.damaged(mutators.Undamaged(number)) for number in range(CHOICES)}
        refused = 0
        for data in seeds:
            report = Report(name=reader.name)
            try_case(reader, folder / f"{reader.name.replace(chr(32), chr(95))}{reader.suffix}", data, report)
            wrong += [f"{reader.name}: {dict(report.failures)}"] * bool(report.failures)
            wrong += [f"{reader.name}: {report.peak_mb:.0f} MB"] * (report.peak_mb > 500)
            refused += report.refused
        if refused > REFUSED.get(reader.name, 0):
            wrong.append(f"{reader.name}: {refused} of {len(seeds)} seeds are refused")
    assert not wrong, "; ".join(wrong)


def test_every_reader_has_seeds(readers: list[Reader]):
    """Of every kind of file that a command takes."""
    names = " ".join(reader.name for reader in readers)
    for kind in (
        "activities",
        "board",
        "antennas",
        "views",
        "pcap",
        "bvh",
        "safetensors",
        "zarr",
        "scan of Record3D",
        "ROS bag",
        "task file",
        "recogniser",
        "request of the studio",
        "weights",
        "mmw",
        "mmwl",
        "mesh .glb",
        "stream",
        "result folder",
        "camera.json",
        "class mask",
        "radar.json",
        "TI cfg",
        "log of a training",
    ):
        assert kind in names, kind  # fmt: skip
