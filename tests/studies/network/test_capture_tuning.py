"""Captures of the study are what a user would have, finished rooms are kept, and rows are means over rooms."""

import argparse
import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.training.captures import read_capture
from studies.network import capture_tuning
from studies.network.capture_tuning import COLUMNS, rows_of, scores_of, write_capture, write_photo

pytest.importorskip("zarr")


def test_a_capture_is_read_back_with_its_photo_and_joints(tiny_geometry: Path, tmp_path: Path):
    room = read_rooms(tiny_geometry)[0]
    grid = CubeGrid.of(room.config, room.joints_m.shape[1])
    values = np.random.default_rng(0).normal(size=(*grid.shape, 2)).astype(np.float32).view(np.complex64)[..., 0]
    cube = RadarCube(values=values, grid=grid, config=room.config, scale=1.0)
    write_photo(tmp_path, room.photo)
    for joints in (True, False):
        capture = read_capture(write_capture(tmp_path / f"joints_{joints}", room, 0, cube, joints=joints))
        assert np.array_equal(capture.cube.values, cube.values)
        assert np.array_equal(capture.photo.depth_m, room.photo.depth_m, equal_nan=True)
        assert (capture.pose is not None) is joints
        if capture.pose is not None:
            assert np.allclose(capture.pose.joints_m, room.joints_m[0], atol=1e-6)


def test_a_finished_room_is_kept_for_the_same_settings(
    tiny_geometry: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    made = []

    def one_room(*given: object) -> dict[str, list[dict[str, float]]]:
        made.append(given)
        return {"untuned": [dict.fromkeys(COLUMNS, float(len(made)))]}

    monkeypatch.setattr(capture_tuning, "one_room", one_room)
    weights = tmp_path / "weights"
    weights.write_bytes(b"first")
    settings = argparse.Namespace(work=tmp_path, weights=weights, captures=4, each=4, steps=None)
    room = read_rooms(tiny_geometry)[0]
    first = scores_of(room, settings, 0)
    assert scores_of(room, settings, 0) == first
    assert len(made) == 1
    weights.write_bytes(b"second")
    assert scores_of(room, settings, 0) != first
    assert json.loads((tmp_path / room.folder.name / "scores.json").read_text())["settings"]["captures"] == 4


def test_rows_count_rooms_alike_however_many_sequences_they_have():
    rooms = [{"untuned": [dict.fromkeys(COLUMNS, 0.0)] * 3}, {"untuned": [dict.fromkeys(COLUMNS, 1.0)]}]
    (row,) = rows_of(rooms)
    assert (row["n"], row["num_rooms"]) == (4, 2)
    assert row["metrics"]["ra_ssim"]["value"] == 0.5
    assert row["metrics"]["ra_ssim"]["interval_95"] == [0.0, 1.0]
