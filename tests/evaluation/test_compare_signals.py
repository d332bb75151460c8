"""What was changed in a signal is what gives it away; nothing gives away a signal of the same making."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.evaluation.compare_signals import FEATURES, compare
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.mmwave_studio import read_mmwave_studio
from mmweaver.io.raw_npy import read_adc_npy
from tests.evaluation.made_signals import RADAR, samples, still
from tests.evaluation.test_person_features import walking

ROOM = [still(1.0 + 0.37 * at, 1.0 / (1 + at), 0.15 * at - 0.5) for at in range(8)]


def made(seed: int, *, ghost: float = 0.1) -> AdcCube:
    people = [walking(1.5, 1.0), walking(2.3, ghost)]
    return samples([*ROOM, *people], frames=6, noise=0.05, seed=seed)


def test_signals_of_one_making_cannot_be_told_apart_and_a_change_is_named():
    same = compare(made(0), made(1))
    assert [one.feature.name for one in same.ranked if one.gives_away] == []
    other = made(2, ghost=0.004)
    leaking = (other.samples + 3 * np.linspace(0.1, 1, 12).reshape(3, 4, 1)).astype(np.complex64)
    found = compare(made(0), replace(other, samples=leaking))
    away = {one.feature.name: one for one in found.ranked if one.gives_away}
    assert {"behind_body_near", "leakage_level", "leakage_spread"} <= set(away)
    assert away["behind_body_near"].difference is not None
    assert away["behind_body_near"].difference.difference < -5


def test_the_record_is_json_and_names_every_feature():
    values = compare(made(0), made(1)).to_values()
    assert set(values["features"]) == {feature.name for feature in FEATURES}
    assert json.loads(json.dumps(values, allow_nan=False)) == values
    seated = values["features"]["seated_3_to_5_hz"]
    assert seated["a"]["value"] is None
    assert "8 s" in seated["a"]["cannot_see"]
    assert seated["difference"] is None


def test_one_long_frame_is_measured_on_its_quarters():
    config = replace(RADAR, num_loops=64)
    one_frame = samples(ROOM, frames=1, config=config, noise=0.05)
    found = compare(one_frame, samples(ROOM, frames=6, noise=0.05, seed=1))
    by_name = {one.feature.name: one for one in found.features}
    noise = by_name["noise_level"]
    assert noise.a.units == "quarters of frames"
    assert noise.difference is not None
    assert noise.difference.difference == pytest.approx(0, abs=0.3)
    assert by_name["first_chirp_phase"].a.units == "frames"


def test_folders_of_recordings_spread_over_recordings():
    few = [replace(made(seed), samples=made(seed).samples[:2]) for seed in range(4)]
    found = compare(few, list(reversed(few)))
    noise = next(one for one in found.features if one.feature.name == "noise_level")
    assert noise.a.units == "recordings"
    assert noise.a.spread is not None
    assert noise.a.spread.units == 4
    assert found.sides[0].frames == 8


def test_lost_frames_are_left_out_and_a_signal_of_zeros_is_one_line():
    whole = made(0)
    lost = whole.samples.copy()
    lost[2] = 0
    found = compare(whole, replace(whole, samples=lost))
    by_name = {one.feature.name: one for one in found.features}
    for name in ("noise_level", "antenna_spread", "clutter_peak_over_median", "leakage_level"):
        spread = by_name[name].b.spread
        assert spread is not None
        assert spread.units == 5, name
    with pytest.raises(InputError, match="nothing but zeros"):
        compare(whole, replace(whole, samples=0 * lost))


def test_recorded_boards_have_the_values_that_were_found_in_them(real_data: Path):
    """Noise at both ends of the band, clutter, plane waves, antennas, leakage: two TI boards, one by Infineon."""
    folder = real_data / "radar" / "iwr6843_dca1000"
    hall = read_bin(folder / "adc_data_example.bin", read_mmwave_studio(folder / "mmwaveDevice.mmwave.json"))
    breath = real_data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    found = compare(hall, read_adc_npy(breath, BGT60, "frame,rx,loop,sample"))
    value = {one.feature.name: one.a.spread.median for one in found.features if one.a.spread is not None}
    assert -9.5 < value["if_last_of_band"] < -4
    assert -5 < value["if_near_band"] < -1
    assert 11 < value["clutter_peak_over_median"] < 16.5
    assert 0.5 < value["plane_wave_share"] < 0.9
    assert 2.2 < value["antenna_spread"] < 4.5
    assert 15 < value["leakage_spread"] < 22
    assert {"behind_body_near", "drift"}.isdisjoint(value)
