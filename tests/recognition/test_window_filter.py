"""Neighbours, echoes and fans are left out together; older models leave out movers of the empty place alone."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.busy_places import busy_cells
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.radar_facts import RadarFacts
from mmweaver.recognition.window_filter import WindowFilter

FACTS = RadarFacts(
    range_step_m=0.05, velocity_step_mps=0.12, max_velocity_mps=0.96, removes_static=False, groups_range=True,
    groups_velocity=True, knows_place=True,
)  # fmt: skip
PERSON, FLANK, ECHO, FAN = (0.0, 2.0, 0.36), (0.0, 2.0, 0.48), (1.5, 3.5, 0.36), (-2.0, 1.0, 0.6)
FRAMES = 20


def recording(*places: tuple[float, float, float]) -> PointRecording:
    """Points at (right, ahead, velocity) in every frame; the person's are strongest."""
    x, y, velocity = np.tile(np.array(places).T, FRAMES)
    cloud = PointCloud(
        frame=np.repeat(np.arange(FRAMES), len(places)), x_m=x, y_m=y, z_m=np.zeros(len(x)),
        radial_velocity_mps=velocity, snr_db=np.where(velocity == PERSON[2], 20.0, 10.0),
    )  # fmt: skip
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=10.0)


def kept(points: WindowFilter) -> int:
    return len(points(recording(PERSON, FLANK, ECHO, FAN)).cloud.frame) // FRAMES


def test_of_a_person_with_all_disturbances_one_point_a_frame_stays():
    busy = busy_cells([recording(FAN)])
    assert kept(WindowFilter(busy=busy, facts=FACTS)) == 1
    assert kept(WindowFilter(busy=busy)) == 3
    assert kept(WindowFilter()) == 4
