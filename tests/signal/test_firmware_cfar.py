"""Detection matrix, CFAR in integer logarithms, peak grouping."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import IWR6843_ISK
from mmweaver.core.firmware_settings import SDK3, FirmwareCfar, FirmwareSettings
from mmweaver.core.seeding import stream
from mmweaver.signal.firmware_cfar import cfar_detections, detection_matrix, is_local_peak, noise_level, reported_share


def test_fifteen_db_are_1280_or_5120():
    """TI's own pair of figures for the IWR1443 and, with eight antennas, the xWR16xx."""
    spectrum = np.full((1, 2, 1, 8), 100 + 0j, np.complex64)
    spectrum[0, 1] *= 10 ** (15 / 20)
    for device, counts in (("xwr14xx", 1280), ("xwr16xx", 5120)):
        matrix = detection_matrix(spectrum, device)
        assert matrix.level[0, 1, 0] - matrix.level[0, 0, 0] == pytest.approx(counts, rel=0.01)
    assert detection_matrix(np.zeros((1, 1, 1, 8), np.complex64), "xwr14xx").level.item() == 0
    twelve = detection_matrix(np.full((1, 1, 1, 12), 2.0**10 + 0j, np.complex64), "xwr14xx")
    assert twelve.level.item() == 10 * 512 * 12 // 16
    assert twelve.counts_per_octave == 512 * 12 / 16


@pytest.mark.parametrize("cyclic", [False, True])
@pytest.mark.parametrize("average", ["ca", "caso", "cago"])
def test_noise_against_a_loop(average: str, cyclic: bool):
    level = stream(3, "levels").integers(0, 4000, (40, 3))
    cfar = FirmwareCfar(average=average, window=8, guard=2, noise_shift=3, cyclic=cyclic)
    noise = noise_level(level, cfar, 4)
    for at in range(40):
        left, right = np.arange(at - 6, at - 2), np.arange(at + 3, at + 7)
        inside = [side for side in (left, right) if cyclic or (side[0] >= 0 and side[-1] < 40)]
        sides = [level[side % 40].sum(axis=0) for side in inside]
        if len(sides) == 1:
            expected = sides[0] // 4
        elif average == "ca":
            expected = (sides[0] + sides[1]) // 8
        else:
            expected = (np.minimum if average == "caso" else np.maximum)(*sides) // 4
        assert np.array_equal(noise[at], expected)


def test_a_map_without_training_cells_detects_nothing():
    level = np.full((10, 4), 5)
    level[5, 2] = 9000
    passed, *_ = cfar_detections(level, FirmwareSettings(), 512.0)
    assert not passed.any()


def test_caso_detects_next_to_a_step_and_cago_does_not():
    level = np.full((60, 8), 1000)
    level[30:] = 4000
    level[27, 3] = 3000
    for average, seen in (("caso", True), ("cago", False)):
        settings = FirmwareSettings(range_cfar=FirmwareCfar(average=average, guard=1, threshold=1500))
        passed, over_db, _ = cfar_detections(level, settings, 512.0)
        assert passed[27, 3] == seen
    assert over_db.shape == level.shape


def test_both_directions_must_pass():
    level = np.full((60, 32), 1000)
    level[20, :] = 4000  # a ridge in range that is flat in Doppler
    level[40, 9] = 4000
    one = FirmwareSettings(range_cfar=FirmwareCfar(threshold=1280))
    both = replace(one, doppler_cfar=FirmwareCfar(threshold=1280, cyclic=True))
    assert cfar_detections(level, one, 512.0)[0][20].all()
    assert [tuple(cell) for cell in np.argwhere(cfar_detections(level, both, 512.0)[0])] == [(40, 9)]


def test_the_window_spans_both_sides_on_one_device_and_each_on_the_other():
    level = np.zeros((60, 1), int)
    level[30 + 4 + 1 + 4 :] = 800  # from the fifth training cell on
    cfar = FirmwareCfar(average="cago", window=8, guard=4, noise_shift=4, threshold=0)
    noise = {half: noise_level(level, cfar, half)[30, 0] for half in (4, 8)}
    assert noise == {4: 0, 8: 400}
    level[30] = 300
    passed = {
        device: cfar_detections(level, FirmwareSettings(device=device, range_cfar=cfar), 512.0)[0][30, 0]
        for device in ("xwr14xx", "xwr16xx")
    }
    assert passed == {"xwr14xx": True, "xwr16xx": False}


def test_peak_grouping():
    level = np.zeros((12, 8), int)
    level[4:7, 2:5] = [[1, 5, 1], [6, 9, 7], [1, 8, 2]]
    names = {(False, False): None, (True, False): None, (False, True): None, (True, True): None}
    for in_range, in_doppler in names:
        settings = FirmwareSettings(group_range=in_range, group_doppler=in_doppler, first_range_bin=4, last_range_bin=6)
        peak = is_local_peak(level, settings)
        assert not peak[:4].any()
        assert not peak[7:].any()
        found = {int(value) for value in level[peak] if value}
        expected = {
            (False, False): {1, 5, 6, 7, 9, 8, 2},
            (True, False): {6, 9, 7},
            (False, True): {5, 9, 8},
            (True, True): {9},
        }
        assert found == expected[in_range, in_doppler]


def test_peak_grouping_is_cyclic_in_doppler_and_limited_in_range():
    level = np.zeros((10, 8), int)
    level[5, 0], level[5, 7], level[6, 0] = 5, 6, 9
    settings = FirmwareSettings(first_range_bin=1, last_range_bin=5)
    peak = is_local_peak(level, settings)
    assert peak[5, 7]
    assert not peak[5, 0]


def test_twelve_antennas_report_three_quarters_of_their_decibels():
    """As in recordings of an IWR6843 with thresholds of 10 dB, whose weakest points have 7.5 dB."""
    rng = np.random.default_rng(0)
    noise = 100 * (rng.standard_normal((1, 64, 16, 12)) + 1j * rng.standard_normal((1, 64, 16, 12)))
    noise[0, 20, 5] += 100_000
    config = replace(IWR6843_ISK, num_loops=16)
    matrix = detection_matrix(noise.astype(np.complex64), "xwr16xx")
    _, over_db, noise_db = cfar_detections(matrix.level[0], SDK3, matrix.counts_per_octave)
    expected_db = 20 * np.log10(100_000 / 141) + 2.5  # over the mean logarithm of noise, 2.5 dB below its power
    assert over_db[20, 5] == pytest.approx(expected_db, abs=1.0)
    assert (over_db + noise_db)[20, 5] == pytest.approx(100, abs=0.2)
    assert reported_share("xwr16xx", config.num_antennas) == 0.75
    assert reported_share("xwr14xx", config.num_antennas) == 1.0
