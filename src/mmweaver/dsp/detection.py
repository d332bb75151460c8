"""Point clouds of a cube: by this project's CFAR, or as TI's firmware would report them."""

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.dsp.firmware import check_firmware_radar, firmware_points
from mmweaver.dsp.points import point_cloud

POINTS = ("cfar", "firmware")


def check_points(points: str, config: RadarConfig) -> None:
    """Raises InputError for an unknown kind of point cloud, or one that this radar does not support."""
    if points not in POINTS:
        raise InputError(f"unknown point cloud {points!r}; known: {', '.join(POINTS)}")
    if points == "firmware":
        check_firmware_radar(config)


def detect(cube: RadarCube, adc: AdcCube | None, points: str, firmware: FirmwareSettings | None = None) -> PointCloud:
    """Points of a cube, "cfar" or "firmware"; the firmware uses the ADC samples if given.

    Raises InputError for an unknown kind of point cloud, or a radar that the firmware does not support.
    """
    check_points(points, cube.config)
    if points == "cfar":
        return point_cloud(cube)
    return firmware_points(cube if adc is None else adc, firmware or FirmwareSettings())
