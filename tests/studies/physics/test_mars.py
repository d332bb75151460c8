"""The comparison with MARS, on tables that are made up: what must hold whatever the recordings say."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.manifest import StudyRun
from studies.physics import mars
from studies.physics.cloud_scores import score
from studies.physics.mars import (
    Setup,
    centroid_baseline,
    detect,
    neighbour_oracle,
    same_pose_oracle,
    simulate,
    surface_baseline,
)
from studies.physics.mars_data import MarsStretch, cut, read_mars
from tests.studies.physics.test_mars_data import write_split

HERE = Setup(shift_m=(0.0, 0.0, 0.2), height_m=1.75)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mars")
    for split in ("validate", "test"):
        write_split(folder, split, list(range(40)), moving=0.15)
    return folder


@pytest.fixture(scope="module")
def pieces(folder: Path) -> list[MarsStretch]:
    return cut(read_mars(folder, "test"), 10, 2)


def test_a_swaying_person_gives_points_on_the_body(pieces: list[MarsStretch]):
    clouds = detect(simulate(pieces, HERE), pieces, HERE)
    assert [len(piece) for piece in clouds] == [10, 10]
    every = [cloud for piece in clouds for cloud in piece if len(cloud.x_m)]
    assert len(every) > 12
    range_m = np.concatenate([np.sqrt(cloud.x_m**2 + cloud.y_m**2 + cloud.z_m**2) for cloud in every])
    assert 1.5 < np.median(range_m) < 2.1
    speeds = np.concatenate([np.abs(cloud.radial_velocity_mps) for cloud in every])
    assert 0.1 < speeds.mean() < 0.9


def test_the_same_pose_again_is_a_like_frame_a_second_away(folder: Path):
    stretches = read_mars(folder, "test")
    pieces = cut(stretches, 10, 2)
    (stretch,) = stretches
    joints_m = mars.smoothed(stretch.joints_m)
    place = {id(cloud): at for at, cloud in enumerate(stretch.clouds)}
    for piece, again in zip(pieces, same_pose_oracle(pieces, stretches), strict=True):
        for cloud, other in zip(piece.clouds, again, strict=True):
            at, there = place[id(cloud)], place[id(other)]
            assert abs(stretch.frame[at] - stretch.frame[there]) >= mars.AGAIN_FRAMES
            apart = np.linalg.norm(joints_m - joints_m[at], axis=-1).mean(axis=1)
            assert apart[there] <= np.median(apart)


def test_the_elevated_transmitter_moves_points_up_and_down(pieces: list[MarsStretch]):
    adcs = simulate(pieces, HERE)
    heights = []
    for degrees in (-12.0, 0.0, 12.0):
        clouds = detect(adcs, pieces, replace(HERE, elevation_deg=degrees))
        heights.append(np.median(np.concatenate([cloud.z_m for piece in clouds for cloud in piece])))
    # rows are half a wavelength apart: 12 degrees are a sine of 0.067, at 1.8 m some 12 cm
    assert heights[0] - heights[1] == pytest.approx(0.12, abs=0.06)
    assert heights[1] - heights[2] == pytest.approx(0.12, abs=0.06)


def test_floors_and_ceiling(pieces: list[MarsStretch]):
    real = [piece.clouds for piece in pieces]
    centre = centroid_baseline(pieces, HERE)
    assert all(len(cloud.x_m) == 1 for piece in centre for cloud in piece)
    assert centre[0][0].z_m[0] == pytest.approx(pieces[0].joints_m[0, :, 2].mean() + 0.2)
    skin = surface_baseline(pieces, HERE, 25)
    height = np.concatenate([cloud.z_m for piece in skin for cloud in piece])
    assert 1.2 < np.ptp(height) < 2.0
    assert score(skin, real).value("points") == 25
    neighbour = neighbour_oracle(pieces)
    assert neighbour[0][1] is real[0][0]
    assert neighbour[0][0] is real[0][1]


@pytest.mark.slow  # a whole study; its parts: the tests above and test_cloud_scores.py
def test_the_whole_run(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Small: it writes one file a method, and estimates on validate alone."""
    monkeypatch.setattr(mars, "PIECES", 1)
    monkeypatch.setattr(mars, "PIECES_TO_ESTIMATE", 1)
    monkeypatch.setattr(mars, "PIECE_FRAMES", 10)
    monkeypatch.setattr(mars, "HEIGHTS_M", (0.2, 0.3))
    lines: list[str] = []
    scores = mars.measure(folder, StudyRun("mars", tmp_path), "test", lines.append)
    written = {path.stem for path in (tmp_path / "mars").iterdir()}
    assert written == set(scores) == {
        "baseline_centroid", "baseline_random_on_body", "baseline_random_real_frame", "oracle_neighbouring_frame",
        "oracle_same_pose_again", "simulator",
    }  # fmt: skip
    record = json.loads((tmp_path / "mars" / "simulator.json").read_text())
    assert set(record["config"]["estimated_on_validate"]) == set(Setup.__dataclass_fields__)
    row = record["rows"][0]
    assert row["n"] == 10
    assert row["metrics"]["chamfer_m"]["unit"] == "m"
    assert "validate" not in str(row["dataset"]["sha256"])
