"""Point detectors by name: this project's own CFAR, that of TI's firmware, and registered ones."""

from typing import Protocol, runtime_checkable

from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.registry import Registry
from mmweaver.signal.firmware import check_firmware_radar, firmware_points
from mmweaver.signal.points import point_cloud


@runtime_checkable
class Detector(Protocol):
    """A function from a cube, and its ADC samples where there are some, to points.

    One that cannot do without samples has an attribute `needs_adc` that is true.
    """

    def __call__(self, cube: RadarCube, adc: AdcCube | None, /) -> PointCloud: ...


def _cfar(cube: RadarCube, adc: AdcCube | None, /) -> PointCloud:
    return point_cloud(cube)


def _firmware(cube: RadarCube, adc: AdcCube | None, /) -> PointCloud:
    return firmware_points(cube if adc is None else adc, FirmwareSettings())


DETECTORS: Registry[Detector] = Registry(
    "point cloud", [("cfar", _cfar), ("firmware", _firmware)], entry_points="mmweaver.detectors"
)


def needs_adc(points: str) -> bool:
    """Whether a point cloud is made from ADC samples. Raises InputError for one that is not known."""
    return points == "firmware" or bool(getattr(DETECTORS[points], "needs_adc", False))


def check_points(points: str, config: RadarConfig) -> None:
    """Raises InputError for an unknown kind of point cloud, or one that this radar does not support."""
    detector = DETECTORS[points]
    if detector is _firmware:
        check_firmware_radar(config)


def detect(cube: RadarCube, adc: AdcCube | None, points: str, firmware: FirmwareSettings | None = None) -> PointCloud:
    """Points of a cube.

    Args:
        cube: of any radar that the detector supports.
        adc: its samples, which the firmware's detector uses if given.
        points: "cfar", "firmware" or a registered detector.
        firmware: settings of the firmware's detector.

    Raises:
        InputError: for an unknown kind of point cloud, or a radar that the firmware does not support.
    """
    check_points(points, cube.config)
    detector = DETECTORS[points]
    if detector is _firmware and firmware is not None:
        return firmware_points(cube if adc is None else adc, firmware)
    return detector(cube, adc)
