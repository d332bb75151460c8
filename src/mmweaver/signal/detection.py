"""Point detectors by name: CFAR, the emulated firmware of TI, and registered ones."""

from typing import Protocol, runtime_checkable

from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.registry import Registry
from mmweaver.signal.firmware import check_firmware_radar, firmware_points
from mmweaver.signal.points import point_cloud


@runtime_checkable
class Detector(Protocol):
    """Maps a cube, and its ADC samples if available, to points.

    A detector that requires samples has a true attribute `needs_adc`.
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
    """Whether a detector works on ADC samples.

    Args:
        points: "cfar", "firmware" or a registered detector.

    Raises:
        InputError: For an unknown detector.
    """
    return points == "firmware" or bool(getattr(DETECTORS[points], "needs_adc", False))


def check_points(points: str, config: RadarConfig) -> None:
    """Checks that a detector exists and supports a radar.

    Args:
        points: "cfar", "firmware" or a registered detector.
        config: The radar.

    Raises:
        InputError: For an unknown detector, or a radar that the firmware does not support.
    """
    detector = DETECTORS[points]
    if detector is _firmware:
        check_firmware_radar(config)


def detect(cube: RadarCube, adc: AdcCube | None, points: str, firmware: FirmwareSettings | None = None) -> PointCloud:
    """Detects points.

    Args:
        cube: Cube of a radar that the detector supports.
        adc: Its samples, which the firmware's detector uses if given.
        points: "cfar", "firmware" or a registered detector.
        firmware: Settings of the firmware's detector; by default `FirmwareSettings()`.

    Returns:
        Points of all frames.

    Raises:
        InputError: For an unknown detector, or a radar that the firmware does not support.
    """
    check_points(points, cube.config)
    detector = DETECTORS[points]
    if detector is _firmware and firmware is not None:
        return firmware_points(cube if adc is None else adc, firmware)
    return detector(cube, adc)


def substitutes(points: str, firmware: FirmwareSettings | None) -> tuple[str, ...]:
    """Sentence on the detection chain that the firmware's settings stand in for, if there is one.

    Args:
        points: The detector.
        firmware: Settings of the firmware's detector.
    """
    return (firmware.substitute,) if points == "firmware" and firmware is not None and firmware.substitute else ()
