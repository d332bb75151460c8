"""Rooms as files."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo import read_photo
from mmweaver.scene.procedural.room import make_room
from mmweaver.scene.procedural.room_files import read_classes, write_room


def test_what_is_written_is_read_back(tmp_path: Path):
    room = make_room("kitchen", 2, 3)
    photo = room.photo("tubes", noise=True)
    write_room(tmp_path, room, photo, "tubes")
    again, _ = read_photo(tmp_path / "rgb.png", tmp_path / "depth.png", tmp_path / "camera.json")
    assert np.array_equal(again.rgb, photo.rgb)
    assert np.array_equal(np.isnan(again.depth_m), np.isnan(photo.depth_m))
    assert np.nanmax(np.abs(again.depth_m - photo.depth_m)) < 0.0002
    assert again.intrinsics == photo.intrinsics
    classes = read_classes(tmp_path)
    assert photo.classes is not None
    assert classes.names == photo.classes.names
    assert np.array_equal(classes.index, photo.classes.index)
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["floor_z_m"] == pytest.approx(room.floor_z_m, abs=1e-4)
    assert len(truth["seats"]) == len(room.seats)
    assert {mark["kind"] for mark in truth["landmarks"]} == {mark.kind for mark in room.landmarks}
    assert len(truth["boxes"]) == len(room.boxes)


def test_a_mask_without_its_names_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="no class mask"):
        read_classes(tmp_path)
    room = make_room("corridor")
    write_room(tmp_path, room, room.photo(), "day")
    (tmp_path / "classes.json").write_text('{"names": ["unlabeled"]}')
    with pytest.raises(InputError, match="does not name"):
        read_classes(tmp_path)
