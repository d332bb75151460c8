"""What any radar simulation must obey, whatever its code."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.motion.physiology import STILL, PhysiologySettings
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.antenna import scatterer_gain, specular_gain
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.image_method import specular_paths, specular_reflectors
from mmweaver.propagation.materials import MATERIALS, reflection
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.skin_scattering import LAMBERT
from mmweaver.propagation.static_paths import Propagation
from mmweaver.signal.cube import cube_values
from tests.rooms import back_wall, floor, plane, scene_of, side_wall, standing_person

SYNTHESIS = AdcSynthesis(AWR1843)
SMOOTH = Propagation(fine_roughness=False)


def at_rest(*places: tuple[float, float, float]) -> ApparentPoint:
    """Points that do not move, in the one segment of one frame."""
    motion = np.zeros((1, len(places), 3, 3))
    motion[:, :, 0] = places
    return ApparentPoint.of(motion)


def paths_to(*places: tuple[float, float, float], amplitude: float = 1.0) -> Paths:
    return Paths.direct(torch.full((1, len(places)), amplitude), at_rest(*places))


def loop_spectrum(adc: np.ndarray) -> np.ndarray:
    """Power over Doppler (doppler,) of one frame (loop, tx, rx, sample), zero in the middle."""
    window = np.sin(np.pi * np.arange(adc.shape[0]) / adc.shape[0]) ** 2
    spectrum = np.fft.fftshift(np.fft.fft(adc * window[:, None, None, None], axis=0), axes=0)
    return (np.abs(spectrum) ** 2).sum(axis=(1, 2, 3))


def test_superposition():
    one, two = paths_to((0.3, 2.0, 0.1)), paths_to((-0.5, 1.5, -0.4), amplitude=0.3)
    both = SYNTHESIS.moving(Paths.cat([one, two], 1)).numpy()
    assert np.allclose(both, (SYNTHESIS.moving(one) + SYNTHESIS.moving(two)).numpy(), atol=1e-5)


def test_reciprocity_transmitters_and_receivers_may_change_places():
    """One at a time, so that turns do not matter: tx at A and rx at B hear what tx at B and rx at A hear."""
    a, b = (0.01, 0.0, 0.004), (-0.02, 0.0, 0.0)
    there = replace(AWR1843, tx_position_m=(a,), rx_position_m=(b,), tx_order=(0,))
    back = replace(AWR1843, tx_position_m=(b,), rx_position_m=(a,), tx_order=(0,))
    paths = replace(
        paths_to((0.4, 1.8, -0.3)), arrival=at_rest((1.9, 2.4, -0.2)), is_reciprocal=torch.ones(1, 1, dtype=torch.bool)
    )
    signals = [AdcSynthesis(config).moving(paths)[0].numpy() for config in (there, back)]
    assert np.allclose(signals[0], signals[1], atol=2e-2)
    assert np.abs(signals[0]).max() > 1.0


def test_amplitude_falls_with_the_square_of_the_range():
    """A person glided from 3 m to 6 m before a radar with hardly a beam: a quarter of the amplitude, 12 dB.

    With a skin that has no lobe: further away, more of a body faces the radar.
    """
    everywhere = replace(AWR1843, azimuth_beamwidth_deg=360.0, elevation_beamwidth_deg=360.0)
    simulator = Simulator(scene_of((floor(-50.0),)), everywhere, IDEAL)
    power = []
    for distance_m in (3.0, 6.0):
        total = 0.0
        for subject in range(60):  # speckle averages out
            pose = replace(standing_person((0.0, distance_m, -0.9)), subject=subject)
            adc = simulator.run(pose, num_frames=1, seed=0, echo=LAMBERT).adc.samples[0, :1, :1]
            total += float((np.abs(adc - simulator.room_adc[:1]) ** 2).sum())
        power.append(total)
    assert 10 * np.log10(power[0] / power[1]) == pytest.approx(12.04, abs=1.0)


def test_a_resting_scene_has_no_doppler():
    simulator = Simulator(scene_of((floor(), back_wall(), side_wall())), AWR1843, IDEAL)
    adc = simulator.run(standing_person((0.2, 2.0, -1.2)), num_frames=1, seed=0, motions=STILL).adc.samples[0]
    power = loop_spectrum(adc)
    zero = len(power) // 2
    away = np.delete(power, [zero - 1, zero, zero + 1]).sum()
    assert 10 * np.log10(away / power.sum()) < -60


def test_a_living_person_never_rests():
    """Who stands sways and breathes by millimetres a second: faint against the body, far above nothing."""
    simulator = Simulator(scene_of((floor(),)), AWR1843, IDEAL)
    moving_db = []
    for motions in (PhysiologySettings(), STILL):
        adc = simulator.run(standing_person((0.2, 2.0, -1.2)), num_frames=4, seed=0, motions=motions).adc.samples
        person = adc - simulator.room_adc
        moving = person - person.mean(axis=1, keepdims=True)
        moving_db.append(10 * np.log10((np.abs(moving) ** 2).sum() / (np.abs(person) ** 2).sum()))
    assert -40 < moving_db[0] < -15
    assert moving_db[1] < moving_db[0] - 30


def test_the_last_frame_moves_as_the_others_do():
    """A motion that ends where the last frame begins is carried on, not frozen."""
    simulator = Simulator(scene_of(()), AWR1843, IDEAL)
    person = standing_person((0.0, 2.0, -1.2), (0.0, -1.0, 0.0), seconds=0.101)
    adc = simulator.run(person, num_frames=2, seed=0, motions=STILL).adc.samples
    speeds = [AWR1843.radial_velocity_mps[np.argmax(loop_spectrum(frame))] for frame in adc]
    assert speeds == pytest.approx([-1.0, -1.0], abs=0.3)


def test_jitter_lets_resting_clutter_leak_into_doppler():
    adc = []
    for impairments in (IDEAL, replace(IDEAL, chirp_jitter_s=1.1e-9, phase_noise_dbc_per_hz=-93.0)):
        simulator = Simulator(scene_of((floor(), back_wall())), AWR1843, impairments)
        adc.append(simulator.run(standing_person((0.2, 2.0, -1.2)), num_frames=1, seed=0).adc.samples[0])
    leak_db = 10 * np.log10((np.abs(adc[1] - adc[0]) ** 2).sum() / (np.abs(adc[0]) ** 2).sum())
    assert -60 < leak_db < -30


def test_one_wall_is_the_closed_form_image():
    wall = back_wall(y_m=2.5)
    (path,) = specular_paths(specular_reflectors((wall,)), AWR1843.wavelength_m, AWR1843.centre_frequency_hz)
    assert np.allclose(path.shift_m, [0, 5.0, 0])
    assert np.allclose(path.corners_m, [[0, 2.5, 0]])
    material = MATERIALS["plasterboard"]
    gamma = reflection(material, np.ones(1), AWR1843.centre_frequency_hz)[0] * np.sqrt(1 - material.scattering**2)
    assert path.echoes.value(AWR1843.centre_frequency_hz) == pytest.approx(gamma.conj(), rel=1e-3)
    room = Simulator(scene_of((wall,)), AWR1843, IDEAL, propagation=SMOOTH).room
    echoes = room.paths.select(Interaction.SPECULAR)
    turned = np.exp(2j * np.pi * (echoes.length_m - echoes.length_m[0]).numpy()[:, 0, 0] / AWR1843.wavelength_m)
    total = (echoes.amplitude.numpy() * turned).sum()
    friis = 10 ** ((12 + 2 * 10.5) / 20) * AWR1843.wavelength_m / (4 * np.pi * 5.0)  # sqrt(mW) over the image's 5 m
    assert total == pytest.approx(friis * gamma.conj(), rel=1e-3)
    tx, rx = np.asarray(AWR1843.tx_position_m), np.asarray(AWR1843.rx_position_m)
    image = tx * [1, -1, 1] + [0, 5.0, 0]
    assert np.allclose(echoes.length_m[0], np.linalg.norm(image[:, None] - rx, axis=-1), atol=1e-9)


@pytest.mark.parametrize("name", ["plasterboard", "glass", "brick", "concrete"])
def test_a_wall_reflects_as_the_exact_slab_at_every_frequency(name: str):
    """Samples and cube of a wall straight ahead against the slab's own coefficient at each sample's frequency."""
    wall = back_wall(y_m=2.0, material=name)
    synthesis, material = AdcSynthesis(AWR1843), MATERIALS[name]
    room = Simulator(scene_of((wall,)), AWR1843, IDEAL, propagation=SMOOTH).room
    paths = room.paths.select(Interaction.SPECULAR)
    got = synthesis.static(paths)
    since_s = (np.arange(AWR1843.num_samples) - AWR1843.num_samples / 2) / AWR1843.sample_rate_hz
    frequency_hz = AWR1843.centre_frequency_hz + AWR1843.chirp_slope_hz_per_s * since_s
    gamma = np.array([reflection(material, np.ones(1), one)[0].conj() for one in frequency_hz])
    gamma *= np.sqrt(1 - material.scattering**2)
    front = replace(paths[:1], amplitude=paths.amplitude[:1] / paths.amplitude[0] * specular_gain(AWR1843) / 4.0)
    wanted = synthesis.static(front) * torch.from_numpy(gamma.astype(np.complex64))
    assert error_db(got.numpy(), wanted.numpy()) < -30
    if name != "concrete":  # nothing comes back through it
        assert error_db(synthesis.static(front).numpy() * gamma[len(gamma) // 2], wanted.numpy()) > -20
    renderer = CubeRenderer(AWR1843)
    cells = torch.zeros((1, AWR1843.num_range_bins, AWR1843.num_loops, AWR1843.num_antennas), dtype=torch.complex64)
    renderer.add_static(cells, renderer.static(paths).layer())
    loops = wanted.expand(1, AWR1843.num_loops, -1, -1, -1).contiguous()
    assert error_db(cells.numpy(), cube_values(loops, AWR1843).numpy()) < -30


def error_db(got: np.ndarray, wanted: np.ndarray) -> float:
    return 10 * float(np.log10((np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum()))


def test_a_corner_has_its_double_bounce_once():
    """Wall and floor at right angles: the wall's image and one straight through the corner.

    Straight down to the floor a vertically polarised antenna sends nothing.
    """
    paths = specular_paths(
        specular_reflectors((back_wall(y_m=2.5), floor(-1.2))), AWR1843.wavelength_m, AWR1843.centre_frequency_hz
    )
    images = sorted(tuple(np.round(path.shift_m, 6)) for path in paths)
    assert images == [(0.0, 5.0, -2.4), (0.0, 5.0, 0.0)]
    corner = next(path for path in paths if len(path.corners_m) == 2)
    assert np.allclose(corner.corners_m, [0, 2.5, -1.2], atol=1e-6)
    way = np.array([0, 5.0, -2.4]) / np.hypot(5.0, 2.4)
    expected = (
        -1.0 + 0j
    )  # the field lies in the upright plane of incidence: TM at the wall, too, whose image is upright
    for mirror in specular_reflectors((back_wall(y_m=2.5), floor(-1.2))):
        cos, smooth = np.abs(way @ mirror.plane.normal), np.sqrt(1 - mirror.material.scattering**2)
        at_hz = AWR1843.centre_frequency_hz
        expected *= smooth * complex(reflection(mirror.material, cos, at_hz, polarisation="tm"))
    expected = expected.conjugate()
    assert corner.echoes.value(AWR1843.centre_frequency_hz) == pytest.approx(expected, rel=0.05)


def test_a_corner_of_three_metal_faces_returns_the_field_as_it_came():
    """Perfect mirrors turn E into -E + 2 (n E) n; three at right angles give E again, from any side."""
    faces = (back_wall(y_m=2.5, material="metal"), side_wall(1.5, "metal"), floor(-1.2, "metal"))
    paths = specular_paths(specular_reflectors(faces), AWR1843.wavelength_m, AWR1843.centre_frequency_hz, 1)
    corner = next(path for path in paths if np.allclose(np.abs(path.shift_m), [3.0, 5.0, 2.4]))
    smooth = (1 - MATERIALS["metal"].scattering ** 2) ** 1.5
    assert corner.echoes.value(AWR1843.centre_frequency_hz) == pytest.approx(smooth, abs=0.02)


def test_a_wave_that_meets_a_wall_from_below_is_partly_tm():
    """Closed form at Brewster's angle of glass: the TM part vanishes, so only the part across the plane remains."""
    frequency_hz, material = AWR1843.centre_frequency_hz, MATERIALS["glass"]
    (wall,) = specular_reflectors((back_wall(y_m=2.5, material="glass"),))
    rise = np.radians(60.0)
    straight = np.array([0.0, np.cos(rise), np.sin(rise)])  # upright plane of incidence: TM alone
    tm = wall.echoes(straight, frequency_hz, 1).coefficient[0]
    te = wall.echoes(np.array([np.sin(rise), np.cos(rise), 0.0]), frequency_hz, 1).coefficient[0]  # level: TE alone
    smooth = np.sqrt(1 - material.scattering**2)
    for got, name in ((tm, "tm"), (te, "te")):
        wanted = smooth * reflection(material, np.cos(rise), frequency_hz, polarisation=name)
        assert abs(got) == pytest.approx(abs(complex(wanted)), rel=1e-6)
    assert abs(tm) < 0.4 * abs(te)


def test_ghost_appears_where_the_mirror_says():
    """With a metal wall beside, the mirrored ways of a person add echoes behind the person, and only there."""
    wall = side_wall(x_m=0.9, material="metal")
    person = standing_person((0.0, 1.6, -1.2))
    with_wall = Simulator(scene_of((wall,)), AWR1843, IDEAL)
    without = Simulator(scene_of((floor(-8.0),)), AWR1843, IDEAL)
    extra = with_wall.run(person, num_frames=1, seed=0).adc.samples[0] - with_wall.room_adc
    extra -= without.run(person, num_frames=1, seed=0).adc.samples[0] - without.room_adc
    window = np.sin(np.pi * np.arange(256) / 256) ** 2
    profile = (np.abs(np.fft.fft(extra * window, axis=-1)) ** 2).sum(axis=(0, 1, 2))
    range_m = np.arange(256) * AWR1843.range_resolution_m
    mixed_m = (1.6 + np.hypot(1.8, 1.6)) / 2
    peak_m = range_m[np.argmax(profile)]
    assert mixed_m - 0.35 < peak_m < np.hypot(1.8, 1.6) + 0.35
    assert profile[range_m < 1.5].sum() < 0.02 * profile.sum()


def test_furniture_hides_the_person_and_the_person_hides_the_wall():
    screen = plane("panel", (0.0, 1.0, 0.0), (0, -1, 0), (1, 0, 0), (1.5, 1.2), "metal")
    person = standing_person((0.0, 2.0, -1.2))
    hidden = Simulator(scene_of((screen,)), AWR1843, IDEAL)
    seen = Simulator(scene_of((back_wall(),)), AWR1843, IDEAL)
    echo = hidden.run(person, num_frames=1, seed=0).adc.samples[0] - hidden.room_adc
    assert np.abs(echo).max() == 0
    without_shadow = seen.run(person, num_frames=1, seed=0).adc.samples[0] - seen.room_adc
    from mmweaver.propagation.body_model import body_of
    from mmweaver.propagation.body_paths import BodyPaths

    paths = BodyPaths(seen.room, body_of(person), seen.clock, seen._joints_at_nodes(person, np.arange(1)))
    occluded = paths.occluded_paths(0)
    assert 50 < len(occluded) < len(seen.room.paths) / 2
    assert bool((occluded.departure_vertex_m.norm(dim=1) > 2.0).all())
    person_only = seen.synthesis.moving(Paths.padded(paths.paths(0)))[0].numpy()
    assert np.abs(without_shadow - person_only).max() > 0


def test_thermal_noise_has_the_power_of_its_formula():
    impairments = replace(IDEAL, thermal_noise=True)
    simulator = Simulator(scene_of(()), AWR1843, impairments)
    person = standing_person((0.0, 200.0, -1.2))  # out of earshot
    adc = simulator.run(person, num_frames=1, seed=3).adc.samples
    assert np.mean(np.abs(adc) ** 2) == pytest.approx(AWR1843.noise_power_mw, rel=0.02)
    dbm = 10 * np.log10(AWR1843.noise_power_mw)
    assert dbm == pytest.approx(-174 + 10 * np.log10(4.51e6) + 15, abs=0.2)


def test_samples_are_whole_counts_and_fit_sixteen_bits():
    simulator = Simulator(scene_of((floor(), back_wall())), AWR1843)
    adc = simulator.run(standing_person((0.2, 2.0, -1.2)), num_frames=1, seed=0).adc.samples
    counts = adc.view(np.float32) / AWR1843.adc_count_sqrt_mw
    assert np.abs(counts - np.rint(counts)).max() < 1e-2
    assert 100 < np.abs(counts).max() <= 32768


def test_the_same_seed_gives_the_same_bits_and_another_other_noise():
    simulator = Simulator(scene_of((floor(), back_wall())), AWR1843)
    person = standing_person((0.2, 2.0, -1.2), (0.0, -0.5, 0.0))
    first, again = (simulator.run(person, num_frames=2, seed=0).adc.samples for _ in range(2))
    assert first.tobytes() == again.tobytes()
    first, other = (simulator.run(person, num_frames=2, seed=s, motions=STILL).adc.samples for s in (0, 1))
    assert not np.array_equal(first, other)
    assert np.allclose(first, other, atol=30 * np.sqrt(AWR1843.noise_power_mw))


def test_cutting_the_frames_changes_no_bit(monkeypatch: pytest.MonkeyPatch):
    simulator = Simulator(scene_of((floor(), back_wall())), AWR1843)
    person = standing_person((0.2, 2.0, -1.2), (0.0, -0.5, 0.0))
    whole = simulator.run(person, num_frames=3, seed=0).adc.samples
    monkeypatch.setattr("mmweaver.propagation.ray_traced.CHUNK_FRAMES", 2)
    assert whole.tobytes() == simulator.run(person, num_frames=3, seed=0).adc.samples.tobytes()


def test_gains_are_the_radar_equation_in_decibels():
    c = AWR1843
    one_m2_at_2_m = 20 * np.log10(scatterer_gain(c) / 4)
    by_hand = 12 + 2 * 10.5 + 20 * np.log10(SPEED_OF_LIGHT_MPS / c.centre_frequency_hz)
    by_hand -= 30 * np.log10(4 * np.pi) + 40 * np.log10(2)
    assert one_m2_at_2_m == pytest.approx(by_hand, abs=1e-6)
    friis = 12 + 2 * 10.5 + 20 * np.log10(SPEED_OF_LIGHT_MPS / c.centre_frequency_hz / (4 * np.pi * 5.0))
    assert 20 * np.log10(specular_gain(c) / 5.0) == pytest.approx(friis, abs=1e-6)
