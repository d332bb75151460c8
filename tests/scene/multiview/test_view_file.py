"""views.json: poses relative to the first photo; what is no pose is refused in one line."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.scene.multiview.view_file import read_views
from mmweaver.scene.photo_files import sample_photo

IDENTITY = np.eye(4).tolist()
AHEAD = [[1, 0, 0, 0.0], [0, 1, 0, 0], [0, 0, 1, 2.0], [0, 0, 0, 1]]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from PIL import Image

    folder, (photo, _) = tmp_path_factory.mktemp("views"), sample_photo()
    Image.fromarray(photo.rgb[::4, ::4]).save(folder / "a.png")
    np.save(folder / "a.npy", photo.depth_m[::4, ::4])
    return folder


def written(place: Path, *entries: dict[str, Any]) -> Path:
    file = place / "views.json"
    file.write_text(json.dumps({"photos": [{"rgb": "a.png", "depth": "a.npy", **entry} for entry in entries]}))
    return file


def test_poses_are_relative_to_the_first(place: Path):
    found = read_views(written(place, {"pose": AHEAD}, {"pose": IDENTITY}, {"place_m": [1, 2], "turned_deg": 90}))
    assert np.allclose(np.asarray(found.others[0].pose)[:3, 3], (0, 0, -2))
    assert found.others[1].pose == RadarPose(x_m=1.0, y_m=2.0, yaw_deg=90.0)
    assert {"views", "rgb 1", "depth 3"} <= set(found.files)


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ([{}, {}], r"photo 2.*place_m"),
        ([{}, {"pose": IDENTITY}], "photo 2 has a pose"),
        ([{"place_m": [0, 0]}, {"turned_deg": 90}], "leave its own out"),
        ([{}, {"pose": [[1, 2], [3, 4]]}], "4 x 4"),
        ([{"pose": IDENTITY}, {"pose": (2 * np.eye(4)).tolist()}], "last row"),
        ([{"pose": IDENTITY}, {"pose": np.diag([1, 1, -1, 1]).tolist()}], "no rotation"),
        ([{}, {"turned_deg": "left"}], "turned_deg"),
        ([{}, {"place_m": [1, "2"]}], "place_m is"),
        ([{}, {"place_m": [1, 2, 3]}], "place_m is"),
        ([{}, {"place": [0, 1]}], "may have"),
        ([], "1 to 24 photos"),
    ],
)
def test_what_is_no_pose_is_refused(entries: list[dict[str, Any]], said: str, place: Path):
    with pytest.raises(InputError, match=said):
        read_views(written(place, *entries))
