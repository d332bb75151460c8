"""Which point cloud: this project's own, or the one TI's firmware would report."""

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.dsp.firmware import check_firmware_radar, firmware_points
from mmweaver.dsp.points import point_cloud

POINTS = ("cfar", "firmware")


def check_points(points: str, config: RadarConfig) -> None:
    """Raises InputError for a point cloud that is not known, or that this radar cannot have."""
    if points not in POINTS:
        raise InputError(f"unknown point cloud {points!r}; known: {', '.join(POINTS)}")
    if points == "firmware":
        check_firmware_radar(config)


def detect(cube: RadarCube, adc: AdcCube | None, points: str, firmware: FirmwareSettings | None = None) -> PointCloud:
    """Points of a cube, "cfar" or "firmware"; the firmware starts at the ADC samples where there are some.

    Raises InputError for a point cloud that is not known, or a radar that the firmware is not for.
    """
    check_points(points, cube.config)
    if points == "cfar":
        return point_cloud(cube)
    return firmware_points(cube if adc is None else adc, firmware or FirmwareSettings())
