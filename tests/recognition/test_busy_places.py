"""Where the empty place is busy, what moves is left out; whoever walks through and what is at rest stays."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.busy_places import NO_CELLS, busy_cells, without_busy
from mmweaver.recognition.point_recording import PointRecording

FRAMES = 100


def recording(places: list[tuple[float, float, float]]) -> PointRecording:
    """Points at (right, ahead, velocity), each in every frame."""
    x, y, velocity = np.array(places).T
    cloud = PointCloud(
        frame=np.repeat(np.arange(FRAMES), len(places)), x_m=np.tile(x, FRAMES), y_m=np.tile(y, FRAMES),
        z_m=np.zeros(FRAMES * len(places)), radial_velocity_mps=np.tile(velocity, FRAMES),
        snr_db=np.full(FRAMES * len(places), np.nan),
    )  # fmt: skip
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=10.0)


FAN, BOX, SOMEBODY = (-1.1, 3.3, 0.5), (-1.1, 3.3, 0.0), (0.6, 2.0, -0.5)


def test_a_fan_is_left_out_and_nothing_else():
    cells = busy_cells([recording([FAN, BOX])])
    cloud = without_busy(recording([FAN, BOX, SOMEBODY]), cells).cloud
    assert len(cloud.frame) == 2 * FRAMES
    assert set(cloud.radial_velocity_mps) == {BOX[2], SOMEBODY[2]}


def test_points_beside_a_busy_cell_and_beyond_all_of_them():
    cells = busy_cells([recording([FAN])])
    beside, far = (-1.3, 3.4, 1.0), (-1.9, 3.4, 1.0)
    assert set(without_busy(recording([beside, far]), cells).cloud.x_m) == {far[0]}


def test_who_walks_through_makes_no_cell_busy():
    frame = np.arange(FRAMES)
    way = PointCloud(
        frame=frame, x_m=np.zeros(FRAMES), y_m=1 + 0.15 * frame, z_m=np.zeros(FRAMES),
        radial_velocity_mps=np.full(FRAMES, 1.5), snr_db=np.full(FRAMES, np.nan),
    )  # fmt: skip
    walked = PointRecording(name="one", cloud=way, num_frames=FRAMES, frame_rate_hz=10.0)
    assert len(busy_cells([walked])) == 0


def test_without_an_empty_place_nothing_changes():
    assert busy_cells([]).shape == (0, 2)
    one = recording([SOMEBODY])
    assert without_busy(one, NO_CELLS) is one
