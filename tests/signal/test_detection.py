"""Point detectors by name."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.signal.detection import check_points, detect
from mmweaver.signal.firmware import FirmwareCloud, firmware_points
from mmweaver.signal.points import point_cloud
from tests.cubes import point_adc, point_cube


def test_by_name():
    cube, adc = point_cube(), point_adc(noise=0.3)
    assert np.array_equal(detect(cube, adc, "cfar").x_m, point_cloud(cube).x_m)
    ours = detect(cube, adc, "firmware")
    assert isinstance(ours, FirmwareCloud)
    assert np.array_equal(ours.x_m, firmware_points(adc).x_m)
    assert isinstance(detect(cube, None, "firmware"), FirmwareCloud)


def test_another_name_is_refused():
    with pytest.raises(InputError, match="known: cfar, firmware"):
        check_points("lidar", AWR1843)
    with pytest.raises(InputError, match="use --points cfar"):
        check_points("firmware", BGT60)
    check_points("cfar", BGT60)
