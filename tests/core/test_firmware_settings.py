"""Settings of the firmware's point cloud."""

from typing import Any

import pytest

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FIRMWARE, FirmwareCfar, FirmwareSettings


def test_defaults_are_the_3d_profile_of_the_iwr1443():
    settings = FirmwareSettings()
    assert settings.range_cfar == FirmwareCfar(average="caso", window=8, guard=4, noise_shift=3, threshold=1280)
    assert settings.doppler_cfar is None


def test_presets_with_firmware_exist():
    assert set(FIRMWARE) <= set(PRESETS)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"device": "xwr12xx"}, "xwr14xx, xwr16xx"),
        ({"range_cfar": None}, "add a cfarCfg"),
        ({"first_range_bin": 9, "last_range_bin": 8}, "no span"),
        ({"second_peak": 1.5}, "0 to 1"),
        ({"most_objects": 0}, "at least 1"),
    ],
)
def test_impossible_settings(values: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        FirmwareSettings(**values)


@pytest.mark.parametrize(
    "values", [{"average": "os"}, {"window": 1}, {"guard": -1}, {"noise_shift": 0}, {"threshold": -1}]
)
def test_impossible_cfars(values: dict[str, Any]):
    with pytest.raises(InputError):
        FirmwareCfar(**values)
