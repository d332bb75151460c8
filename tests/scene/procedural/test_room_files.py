"""Files of a procedural room."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.procedural.room_files import write_room
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.segmentation.class_file import read_class_file


def test_what_is_written_is_read_back(tmp_path: Path):
    room = make_room("kitchen", 2, 3)
    photo = room.photo("tubes", noise=True)
    write_room(tmp_path, room, photo, "tubes")
    again, _ = read_photo(tmp_path / "rgb.png", tmp_path / "depth.png", tmp_path / "camera.json")
    assert np.array_equal(again.rgb, photo.rgb)
    assert np.array_equal(np.isnan(again.depth_m), np.isnan(photo.depth_m))
    assert np.nanmax(np.abs(again.depth_m - photo.depth_m)) < 0.0002
    assert again.intrinsics == photo.intrinsics
    classes = read_class_file(tmp_path / "classes.png", photo.rgb.shape[1], photo.rgb.shape[0])
    assert photo.classes is not None
    assert np.array_equal(np.array(classes.names)[classes.index], np.array(photo.classes.names)[photo.classes.index])
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["floor_z_m"] == pytest.approx(room.floor_z_m, abs=1e-4)
    assert len(truth["seats"]) == len(room.seats)
    assert {mark["kind"] for mark in truth["landmarks"]} == {mark.kind for mark in room.landmarks}
    assert len(truth["boxes"]) == len(room.boxes)
