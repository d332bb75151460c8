"""A board with every error is the same in both renderers, and does what its fields say."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843, HUPR
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL, Impairments, Receiver
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.cube import cube_values, radar_cube
from tests.propagation.test_cube_rendering import BPM, error_db, sampled
from tests.rooms import back_wall, floor, scene_of

FEW_LOOPS = replace(AWR1843, name="few", num_loops=2)


def every_error(config: RadarConfig) -> Board:
    """A board with large errors of every kind."""
    rng = np.random.default_rng(3)
    pairs, antennas = (config.num_tx, config.num_rx), config.num_tx * config.num_rx
    return Board(
        name="every error",
        if_share=np.array([0.0, 0.05, 0.3, 0.5]), if_gain_db=np.array([-8.0, -2.0, 0.0, -3.0]),
        if_phase_deg=np.array([30.0, 10.0, 0.0, -20.0]),
        channel_gain_db=rng.normal(0, 2, pairs), channel_phase_deg=rng.normal(0, 30, pairs),
        coupling_real=np.eye(antennas) + rng.normal(0, 0.05, (antennas, antennas)),
        coupling_imag=rng.normal(0, 0.05, (antennas, antennas)),
        leakage_range_m=np.array([0.0, 0.3, 1.2]), leakage_level_db=rng.uniform(-80, -60, (3, *pairs)),
        leakage_phase_deg=rng.uniform(-180, 180, (3, *pairs)),
        elevation_phase_deg=12.0, range_bias_m=0.1, first_chirp_amplitude_percent=5.0, first_chirp_phase_mrad=30.0,
        drift_ppm=2.0, gain_db=3.0, noise_figure_db=13.0, element_spacing_m=1.02 * config.wavelength_m / 2,
    )  # fmt: skip


@pytest.mark.parametrize("config", [AWR1843, FEW_LOOPS, HUPR, BPM], ids=lambda config: config.name)
def test_both_renderers_have_the_same_board(config: RadarConfig):
    board = BoardEffects(every_error(config), config)
    renderer = CubeRenderer(board.radar, board)
    synthesis = AdcSynthesis(board.radar, board=board, is_faded=True)
    frames = np.array([0, 40])
    moving = board.recorded_moving(sampled(config, 0.7, 0.0), frames, 1)
    rng = np.random.default_rng(1)
    place = rng.uniform((-1.0, 1.2, -0.5), (1.0, 2.6, 0.5), (60, 3))
    static = board.recorded_static(scattered_paths(place, rng.normal(size=60) + 0j, Interaction.DIFFUSE, board.radar))
    still = synthesis.static(static)
    adc = synthesis.moving(moving) + still + synthesis.leakage(*board.leakage)
    adc[:, 0, board.first_slot] *= board.first_chirp
    values = renderer.moving(moving)
    renderer.add_static(values, renderer.static(static).layer() + renderer.leakage(*board.leakage))
    assert error_db(values, cube_values(adc, config)) < -34
    alone = synthesis.leakage(*board.leakage).expand(1, config.num_loops, -1, -1, -1)
    layer = torch.zeros_like(values[:1])
    renderer.add_static(layer, renderer.leakage(*board.leakage))
    wanted = alone.clone()
    wanted[:, 0, board.first_slot] *= board.first_chirp
    assert error_db(layer, cube_values(wanted, config)) < -36


def one_target(board: Board | None, config: RadarConfig = AWR1843, frames: int = 1) -> np.ndarray:
    """The static peak (antenna,) of a small target at 2 m to the upper right, in each of some frames."""
    return cube_of_target(board, config, frames)[:, :, config.num_loops // 2]


def test_a_gain_is_of_what_is_resolved_and_of_people_not_of_clutter():
    """Clutter's level was recorded over the noise of boards that have a gain."""
    effects = BoardEffects(Board(gain_db=-8.0), AWR1843)
    place_m, one = np.array([[0.0, 2.0, 0.0], [1.0, 3.0, 0.5]]), np.ones(2, complex)
    for kind, wanted_db in ((Interaction.DIFFUSE, -8.0), (Interaction.SPECULAR, -8.0), (Interaction.CLUTTER, 0.0)):
        amplitude = effects.recorded_static(scattered_paths(place_m, one, kind, AWR1843)).amplitude
        np.testing.assert_allclose(20 * np.log10(np.abs(amplitude.numpy())), wanted_db, atol=1e-4)


def cube_of_target(board: Board | None, config: RadarConfig, frames: int) -> np.ndarray:
    effects = None if board is None else BoardEffects(board, config)
    radar = config if effects is None else effects.radar
    motion = np.zeros((frames, 1, 3, 3))
    motion[..., 0, :] = 2.0 * np.array([0.3, np.sqrt(1 - 0.09 - 0.01), 0.1])
    paths = Paths.direct(torch.ones(frames, 1, dtype=torch.complex64), ApparentPoint.of(motion))
    if effects is not None:
        paths = effects.recorded_moving(paths, np.arange(frames), 0)
    return CubeRenderer(radar, effects).moving(paths).numpy()


def test_each_error_is_what_its_field_says():
    ideal = one_target(None)[0]
    peak = int(np.abs(ideal).sum(axis=1).argmax())

    def ratio(**fields) -> np.ndarray:
        return one_target(Board(**fields))[0][peak] / ideal[peak]

    np.testing.assert_allclose(ratio(gain_db=6.0), 10**0.3, rtol=1e-4)
    share = np.array([0.0, 1.0])
    filtered = ratio(if_share=share, if_gain_db=np.array([-6.0, -6.0]), if_phase_deg=np.array([40.0, 40.0]))
    np.testing.assert_allclose(filtered, 10**-0.3 * np.exp(1j * np.radians(40)), rtol=1e-4)
    gain_db, phase_deg = np.arange(12.0).reshape(3, 4), 10 * np.arange(12.0).reshape(3, 4)
    channels = ratio(channel_gain_db=gain_db, channel_phase_deg=phase_deg)
    np.testing.assert_allclose(channels, (10 ** (gain_db / 20) * np.exp(1j * np.radians(phase_deg))).ravel(), rtol=1e-4)
    elevation = np.angle(ratio(elevation_phase_deg=9.0), deg=True)
    np.testing.assert_allclose(elevation, np.repeat([0, 9, 0], 4), atol=0.01)
    swapped = np.eye(12)[::-1]
    mixed = one_target(Board(coupling_real=swapped, coupling_imag=0 * swapped))[0][peak]
    np.testing.assert_allclose(mixed, ideal[peak, ::-1], rtol=0.04)  # each keeps its share of a range bin
    far = np.abs(one_target(Board(range_bias_m=AWR1843.range_resolution_m))[0])
    np.testing.assert_allclose(far[1:], np.abs(ideal)[:-1], atol=0.02 * np.abs(ideal).max())


def test_antennas_stay_where_the_board_has_them():
    """A target at one side gathers the phases of the true spacing; the cube's grid names the radar's own."""
    spacing_m = 1.05 * AWR1843.wavelength_m / 2
    row = np.angle(one_target(Board(element_spacing_m=spacing_m))[0][:, :4].sum(axis=0))
    plain = np.angle(one_target(None)[0][:, :4].sum(axis=0))
    turn = [np.median(np.angle(np.exp(1j * np.diff(phase)))) for phase in (row, plain)]
    assert turn[0] / turn[1] == pytest.approx(1.05, rel=0.02)


def test_drift_turns_static_cells_by_their_range():
    ppm = 2.0
    board = Board(drift_ppm=ppm)
    simulator = Simulator(scene_of((floor(), back_wall())), AWR1843, IDEAL, board=board)
    adc = simulator.run((), num_frames=40, seed=5).adc
    still = radar_cube(adc).values[:, :, 16]
    at = int(np.abs(still[0]).sum(axis=1).argmax())
    turn = np.angle((still[:, at] * still[0, at].conj()).sum(axis=1))
    effects = BoardEffects(board, AWR1843)
    drift = effects.drift(np.arange(40), 5)
    wanted = 4 * np.pi * AWR1843.range_m[at] / AWR1843.wavelength_m * (drift - drift[0])
    np.testing.assert_allclose(turn, wanted, atol=0.15 * np.abs(wanted).max())
    many = effects.drift(np.arange(20000), 5)
    assert np.sqrt((many**2).mean()) == pytest.approx(ppm * 1e-6, rel=0.1)


def test_noise_is_that_behind_the_filter():
    share = np.array([0.0, 0.5, 1.0])
    board = Board(if_share=share, if_gain_db=np.array([-10.0, 0.0, -6.0]), if_phase_deg=np.zeros(3))
    for impairments in (Impairments(), replace(Impairments(), quantise=False)):
        receiver = Receiver(AWR1843, impairments, 0, BoardEffects(board, AWR1843))
        noise = np.concatenate([receiver.noise((32, 3, 4, 256), frame) for frame in range(4)])
        power = (np.abs(np.fft.fft(noise)) ** 2).mean(axis=(0, 1, 2)) / 256 / AWR1843.noise_power_mw
        level_db = 10 * np.log10(power.reshape(16, 16).mean(axis=1))
        np.testing.assert_allclose(level_db, np.interp((np.arange(16) + 0.47) / 16, share, board.if_gain_db), atol=0.4)


def test_the_first_chirp_of_a_frame_differs():
    board = Board(first_chirp_amplitude_percent=0.5, first_chirp_phase_mrad=2.0)
    simulator = Simulator(scene_of((floor(), back_wall())), AWR1843, IDEAL, board=board)
    adc: AdcCube = simulator.run((), num_frames=1, seed=0).adc
    first, later = adc.samples[0, 0, 0], adc.samples[0, 5, 0]
    ratio = (first * later.conj()).sum() / (np.abs(later) ** 2).sum()
    assert ratio == pytest.approx(1.005 * np.exp(2e-3j), abs=1e-5)
    np.testing.assert_array_equal(adc.samples[0, 0, 1], adc.samples[0, 5, 1])


def test_an_unbalanced_mixer_shows_every_echo_at_the_negative_beat():
    """1 dB and 5 degrees: an image of |1 - g exp(j phi)| / 2, -22.5 dB."""
    board = Board(iq_gain_db=1.0, iq_phase_deg=5.0)
    scene = scene_of((back_wall(y_m=2.5, material="metal"),))
    images = []
    for one in (None, board):
        samples = Simulator(scene, AWR1843, IDEAL, board=one).run((), num_frames=1, seed=0).adc.samples[0]
        power = (np.abs(np.fft.fft(samples * np.hanning(256), axis=-1)) ** 2).mean(axis=(0, 1, 2))
        peak = int(power.argmax())
        images.append(10 * np.log10(power[-peak] / power[peak]))
    expected = 20 * np.log10(abs(1 - 10 ** (1 / 20) * np.exp(1j * np.radians(5))) / 2)
    assert images[0] < expected - 15
    assert images[1] == pytest.approx(expected, abs=0.3)
