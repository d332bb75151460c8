"""Recordings of a task: columns by name, labels by folder, samples between gaps, short performances as windows."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.npz_files import write_points_npz
from mmweaver.recognition.point_recordings import (
    PointRecording,
    hole_frames,
    read_task_recording,
    read_task_recordings,
    samples_of,
    windows_of,
)
from mmweaver.recognition.task_file import RecordedColumns, RecordingSettings
from tests.recognition.clouds import recording_of

COLUMNS = RecordedColumns.of(["x_ahead", "y_left", "z_up", "range", "velocity_towards", "snr"], "here")
SETTINGS = RecordingSettings(labels=("up", "walk"), window_s=1.0, frame_rate_hz=10.0, columns=COLUMNS)


def recording(*frames: int, num_frames: int = 40) -> PointRecording:
    return recording_of(frames, snr_db=0.0, num_frames=num_frames, name="a")


def test_columns_are_what_their_names_say(tmp_path: Path):
    (tmp_path / "up").mkdir()
    np.savez(tmp_path / "up" / "a.npz", frame=[7, 7, 9], pts=[[1, 2, 3, 9, 0.5, 20], [4, 5, 6, 9, -1, 30], [0] * 6])
    (one,) = read_task_recordings(tmp_path, SETTINGS)
    assert one.label == "up"
    assert one.num_frames == 3  # an empty one among them
    assert one.cloud.x_m[:2].tolist() == [-2, -5]
    assert one.cloud.y_m[:2].tolist() == [1, 4]
    assert one.cloud.z_m[:2].tolist() == [3, 6]
    assert one.cloud.radial_velocity_mps[:2].tolist() == [-0.5, 1.0]
    assert one.cloud.snr_db[:2].tolist() == [20, 30]


def test_points_that_mmweaver_wrote_need_no_columns(tmp_path: Path):
    cloud = recording(0, 0, 2).cloud
    write_points_npz(tmp_path / "points.npz", replace(cloud, x_m=np.array([1.0, 2.0, 3.0])))
    found = read_task_recording(tmp_path / "points.npz", SETTINGS)
    assert found.num_frames == 3
    assert found.cloud.x_m.tolist() == [1, 2, 3]


def test_a_result_folder_is_a_recording_of_all_its_frames(tmp_path: Path):
    folder = tmp_path / "walk" / "result"
    folder.mkdir(parents=True)
    write_points_npz(folder / "points.npz", recording(3, 7).cloud)
    np.savez(folder / "radar.npz", frame_time_s=np.arange(25) / 10)
    np.savez(folder / "pose.npz", joints_m=np.zeros(3))
    for place in (folder, folder / "points.npz"):
        found = read_task_recording(place, SETTINGS)
        assert (found.name, found.num_frames) == ("result", 25)
    (one,) = read_task_recordings(tmp_path, SETTINGS)
    assert (one.label, one.num_frames) == ("walk", 25)
    with pytest.raises(InputError, match=r"10 frames per second, .* 30; .*--fps"):
        read_task_recording(folder, replace(SETTINGS, frame_rate_hz=30.0))
    with pytest.raises(InputError, match=r"no points\.npz"):
        read_task_recording(tmp_path, SETTINGS)


def test_where_a_log_counts_again_another_take_begins(tmp_path: Path):
    np.savez(tmp_path / "a.npz", frame=[4, 6, 2, 3, 1], pts=np.zeros((5, 6)))
    assert read_task_recording(tmp_path / "a.npz", SETTINGS).cloud.frame.tolist() == [0, 2, 102, 103, 203]


def test_a_hole_in_the_frame_numbers_is_missing_frames_and_no_empty_room(tmp_path: Path):
    settings = replace(SETTINGS, labels=("nobody", "walk"), empty_label="nobody", gap_frames=20)
    frame = np.r_[np.arange(100), 2490 + np.arange(100)]
    np.savez(tmp_path / "a.npz", frame=frame, pts=np.ones((200, 6)))
    found = read_task_recording(tmp_path / "a.npz", settings)
    assert (found.num_frames, len(found.missing), found.missing[0], found.missing[-1]) == (2590, 2390, 100, 2489)
    assert [window.first_frame for window in windows_of(found, settings)] == [
        *range(0, 100, 10),
        *range(2490, 2590, 10),
    ]
    # a file that names its number of frames has all of them, and those without points are an empty room
    np.savez(tmp_path / "b.npz", frame=frame, pts=np.ones((200, 6)), num_frames=2590)
    assert len(windows_of(read_task_recording(tmp_path / "b.npz", settings), settings)) == 259


def test_rests_of_some_seconds_are_not_missing():
    assert len(hole_frames(np.array([0, 3, 30, 31, 80, 81, 82]), 10.0)) == 0
    assert hole_frames(np.array([0, 3, 30, 140]), 10.0).tolist() == list(range(31, 140))
    always = np.setdiff1d(np.arange(500), [200, *range(300, 315)])  # points in nearly every frame
    assert hole_frames(always, 10.0).tolist() == list(range(300, 315))


def test_a_longer_gap_begins_a_new_sample():
    found = samples_of(recording(3, 4, 10, 11, 30), gap_frames=5)
    assert [(one.first_frame, one.num_frames) for one in found] == [(3, 9), (30, 1)]  # 5 frames without points are none
    assert [one.num_frames for one in samples_of(recording(3, 4), gap_frames=None)] == [40]
    assert samples_of(recording(), gap_frames=5) == []


def test_a_short_performance_is_a_window_with_empty_frames():
    single = replace(SETTINGS, gap_frames=5)
    found = windows_of(recording(3, 4, *range(20, 40), num_frames=45), single)
    assert [(one.first_frame, one.num_frames) for one in found] == [(3, 10), (20, 10), (30, 10)]
    seldom = replace(SETTINGS, gap_frames=50)  # takes that lie far apart: nothing is filled up
    assert [one.num_frames for one in windows_of(recording(*range(15), num_frames=15), seldom)] == [10]
    assert windows_of(recording(num_frames=25), single) == []
    assert len(windows_of(recording(num_frames=25), seldom)) == 2  # an empty place
    known = replace(single, labels=("empty", "up"), empty_label="empty")
    assert len(windows_of(recording(num_frames=25), known)) == 2
    between = recording(3, 4, 30, num_frames=45)
    assert [one.first_frame for one in windows_of(between, known)] == [3, 5, 15, 30, 31]
    assert [one.first_frame for one in windows_of(replace(between, label="up"), known)] == [3, 30]


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"frame": [0], "pts": np.zeros((1, 4))}, "6 columns are named"),
        ({"frame": [0], "pts": np.full((1, 6), np.nan)}, "not finite"),
        ({"frame": [5], "pts": np.zeros((1, 6)), "num_frames": 3}, "num_frames"),
    ],
)
def test_damaged_files_are_one_line(arrays: dict, message: str, tmp_path: Path):
    np.savez(tmp_path / "walk.npz", **arrays)
    with pytest.raises(InputError, match=message):
        read_task_recordings(tmp_path, SETTINGS)


def test_a_file_must_name_its_activity(tmp_path: Path):
    np.savez(tmp_path / "nothing.npz", frame=[0], pts=np.zeros((1, 6)))
    with pytest.raises(InputError, match="its activity"):
        read_task_recordings(tmp_path, SETTINGS)
    assert read_task_recordings(tmp_path, SETTINGS, labelled=False)[0].label == ""
    with pytest.raises(InputError, match="does not exist"):
        read_task_recordings(tmp_path / "none", SETTINGS)


def test_points_that_name_their_own_columns_are_read_as_they_say(tmp_path: Path):
    """As `mmweaver generate` and `mmweaver points` write them; `columns` are those of `pts`."""
    own = dict.fromkeys(("x_m", "z_m", "snr_db"), np.ones(2)) | {"y_m": [2.0, 3.0], "radial_velocity_mps": [0.5, -0.5]}
    np.savez(tmp_path / "walk.npz", frame=[0, 4], **own)
    (one,) = read_task_recordings(tmp_path, SETTINGS)
    assert (one.label, one.num_frames) == ("walk", 5)
    assert one.cloud.y_m.tolist() == [2.0, 3.0]
    assert one.cloud.radial_velocity_mps.tolist() == [0.5, -0.5]


def test_windows_are_consecutive_or_overlap_and_are_renumbered():
    one = recording_of([0, 3, 3, 4, 9], x_m=np.arange(5.0), num_frames=10, rate_hz=2.0, label="walk")
    windows = one.windows(2.0)
    assert [window.cloud.frame.tolist() for window in windows] == [[0, 3, 3], [0]]
    assert [window.cloud.x_m.tolist() for window in windows] == [[0.0, 1.0, 2.0], [3.0]]
    assert all(window.num_frames == 4 and window.label == "walk" for window in windows)
    assert len(one.windows(2.0, step_s=1.0)) == 4
    assert one.part(0, 3).windows(2.0) == []  # shorter than a window
