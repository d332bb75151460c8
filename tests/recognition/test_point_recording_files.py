"""RadHAR's text files, and .npz."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.recognition.point_recording_files import read_point_recording, read_point_recordings

POINT = """header: 
  seq: 6264
  stamp: 
    secs: 1538888235
    nsecs: 712113897
  frame_id: "ti_mmwave"
point_id: {}
x: {}
y: {}
z: {}
range: 1.5
velocity: {}
doppler_bin: 8
bearing: 38.6
intensity: 13.6
---
"""  # noqa: W291 - as it is published
LABELS = ("boxing", "walk")


def text(*points: tuple) -> str:
    return "".join(POINT.format(*point) for point in points)


def test_a_text_file_has_frames_and_axes(tmp_path):
    path = tmp_path / "walk" / "one.txt"
    path.parent.mkdir()
    path.write_text(text((0, 1.5, 0.25, -0.5, 0.0), (1, 2.0, 0.0, 0.0, -1.2e0), (0, 1.0, 0.0, 0.0, 0.615)))
    (one,) = read_point_recordings(tmp_path, LABELS)
    assert one.label == "walk"
    assert one.num_frames == 2
    assert one.cloud.frame.tolist() == [0, 0, 1]
    assert one.cloud.y_m.tolist() == [1.5, 2.0, 1.0]
    assert one.cloud.x_m.tolist() == [-0.25, 0.0, 0.0]
    assert one.cloud.z_m.tolist() == [-0.5, 0.0, 0.0]
    assert one.cloud.radial_velocity_mps.tolist() == [0.0, -1.2, 0.615]


def test_an_npz_file_holds_the_same(tmp_path):
    points = np.zeros((3, 8), np.float32)
    points[:, 0], points[:, 4] = (1.5, 2.0, 1.0), (0.0, -1.25, 0.5)
    np.savez(tmp_path / "Train_walk_3.npz", frame=np.array([0, 0, 2], np.int32), pts=points)
    (one,) = read_point_recordings(tmp_path, LABELS)
    assert (one.label, one.num_frames) == ("walk", 3)
    assert one.cloud.radial_velocity_mps.tolist() == [0.0, -1.25, 0.5]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("walk_1.txt", b"", "no points"),
        ("walk_1.txt", b"nothing of the kind", "no points"),
        ("walk_1.txt", text((0, 1, 1, 1, 0)).encode()[:-60], "no RadHAR text file"),
        ("walk_1.txt", b"point_id: 0\nx: a\ny: 1\nz: 1\nvelocity: 1\n", "no RadHAR text file"),
        ("walk_1.npz", b"PK no archive", "no plain .npz archive"),
        ("swim_1.txt", text((0, 1, 1, 1, 0)).encode(), "does not name its activity"),
        ("walk_boxing_1.txt", text((0, 1, 1, 1, 0)).encode(), "does not name its activity"),
        ("walk_1.txt", text((0, "nan", 1, 1, 0)).encode(), "not finite"),
        ("walk_1.csv", b"1,2", "holds no recordings"),
    ],
)
def test_bad_files_are_refused_in_one_line(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        read_point_recordings(tmp_path, LABELS)
    assert "\n" not in str(caught.value)


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(InputError, match="is not a folder"):
        read_point_recordings(tmp_path / "none", LABELS)


def test_shapes_of_an_npz_are_checked(tmp_path):
    np.savez(tmp_path / "walk.npz", frame=np.zeros(3, int), pts=np.zeros((2, 8)))
    with pytest.raises(InputError, match="pts"):
        read_point_recording(tmp_path / "walk.npz")
