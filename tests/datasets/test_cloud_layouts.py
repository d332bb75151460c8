"""Clouds of other data sets, read back by readers that follow their published files."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.datasets.cloud_layouts import write_mars, write_radhar
from mmweaver.io.stored_result import StoredResult


def radhar_blocks(text: str) -> list[dict[str, float]]:
    """The numbers of each message that ROS printed."""
    blocks = []
    for block in text.split("---\n")[:-1]:
        pairs = (line.split(":", 1) for line in block.splitlines() if ":" in line)
        blocks.append(
            {
                name.strip(): float(value)
                for name, value in pairs
                if value.strip().replace(".", "").lstrip("-")[:1].isdigit()
            }
        )
    return blocks


def test_radhar_text(result: StoredResult, tmp_path: Path):
    write_radhar(result, tmp_path)
    blocks = radhar_blocks((tmp_path / "radhar.txt").read_text())
    points = result.points
    order = np.argsort(points.frame, kind="stable")
    assert len(blocks) == len(points.frame)
    np.testing.assert_allclose([one["x"] for one in blocks], points.y_m[order])
    np.testing.assert_allclose([-one["y"] for one in blocks], points.x_m[order])
    np.testing.assert_allclose([one["velocity"] for one in blocks], points.radial_velocity_mps[order])
    np.testing.assert_allclose(
        [one["range"] for one in blocks], [np.sqrt(one["x"] ** 2 + one["y"] ** 2 + one["z"] ** 2) for one in blocks]
    )
    stamps = [one["secs"] + one["nsecs"] / 1e9 for one in blocks]
    assert np.allclose(
        np.subtract(stamps, stamps[0]), points.frame[order] * 0.5 - points.frame[order][0] * 0.5, atol=1e-5
    )


def test_mars_tables(result: StoredResult, tmp_path: Path):
    write_mars(result, tmp_path)
    with (tmp_path / "radar_data.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(result.points.frame)
    np.testing.assert_allclose([float(row["X"]) for row in rows], result.points.x_m, rtol=1e-4, atol=1e-6)
    counts = {int(row["Frame #"]): int(row["# Obj"]) for row in rows}
    for frame, count in counts.items():
        assert sum(int(row["Frame #"]) == frame for row in rows) == count
    with (tmp_path / "kinect_data.csv").open() as file:
        poses = list(csv.DictReader(file))
    assert len(poses) == 4
    assert len(poses[0]) == 75
    wrist = [float(poses[3][f"WristLeft_{axis}"]) for axis in "XYZ"]
    np.testing.assert_allclose(wrist, result.poses[0].joints_m[3, joint("left_wrist")], rtol=1e-4)


def test_mars_has_one_person(result: StoredResult, tmp_path: Path):
    with pytest.raises(InputError, match="one person"):
        write_mars(replace(result, poses=()), tmp_path)
