"""The skin's lobe: energy, reciprocity, what a sphere returns, and a person's cross-section."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.body_capsules import CAPSULES, part_of
from mmweaver.core.ray_caster import RayCaster
from mmweaver.motion.physiology import STILL
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.skin_scattering import LAMBERT, SkinEcho
from tests.rooms import STANDING_M, floor, scene_of, standing_person


def test_a_wrinkled_sphere_returns_what_a_smooth_one_does():
    """Geometric optics: pi a^2 |Gamma|^2, whatever the wrinkles, if they are gentle."""
    angle = np.linspace(0, np.pi / 2, 20001)
    ring = 2 * np.pi * np.sin(angle) * (angle[1] - angle[0])  # of a sphere of radius 1
    for slope in (0.03, 0.1):
        total = (SkinEcho(reflectivity=0.5, slope=slope, albedo=0.0).monostatic(np.cos(angle)) * ring).sum()
        assert total == pytest.approx(0.5 * np.pi, rel=0.05)


def test_lambert_is_four_albedo_cos_squared():
    cos = np.array([-0.5, 0.0, 0.3, 1.0])
    assert LAMBERT.monostatic(cos) == pytest.approx([0.0, 0.0, 4 * 0.18 * 0.09, 4 * 0.18])


def test_in_and_out_change_places_and_the_mirror_direction_shines():
    echo = SkinEcho()
    cos_in, cos_out, half = np.array([0.9]), np.array([0.4]), np.array([0.8])
    assert echo.bistatic(cos_in, cos_out, half) == pytest.approx(echo.bistatic(cos_out, cos_in, half))
    sixty = np.array([0.5])
    assert echo.bistatic(sixty, sixty, np.array([1.0]))[0] > 100 * echo.monostatic(sixty)[0]
    assert echo.bistatic(sixty, -sixty, np.array([1.0]))[0] == 0


def test_a_person_is_as_bright_as_published():
    """Far away, averaged over front, side and between: -8 to -4 dBsm (77 GHz: about -5 to -8)."""
    body, joints = ScatteringBody(0, 1.75, 8000), standing_person((0.0, 2.0, -1.2)).joints_m[:1]
    skin = body.skin(joints)
    vertices, faces = body.hull(joints)
    hull = RayCaster(vertices[0], faces)
    total = []
    for degrees in (0, 30, 60, 90):
        towards = np.array([np.sin(np.radians(degrees)), -np.cos(np.radians(degrees)), 0.0])
        clear = hull.is_clear(skin.place_m[0] + 5 * towards, skin.place_m[0], 0.03)
        total.append((body.echo.monostatic(skin.normal[0] @ towards) * clear * body.brightness).sum() * body.area_m2)
    assert -8 < 10 * np.log10(np.mean(total)) < -4


def test_only_skin_that_returns_nothing_is_left_out():
    assert SkinEcho().least_cos == LAMBERT.least_cos == 0.02
    for slope in (0.05, 0.2):
        sharp = SkinEcho(slope=slope, albedo=0.0)
        edge = np.array([sharp.least_cos])
        assert sharp.monostatic(edge) * edge**4 == pytest.approx(1e-6 * sharp.monostatic(np.array([1.0])))


def test_limbs_return_what_is_documented_less_or_more_than_skin_of_the_trunk_would():
    """Legs 6 dB less, arms 2 dB more (docs/radar_primer.md, section 4): from samples, which are sums of amplitudes."""
    simulator = Simulator(scene_of((floor(-8.0),)), AWR1843, IDEAL)
    person = standing_person((0.0, 2.0, -1.2))

    def samples(**limbs: float) -> np.ndarray:
        made = simulator.run(person, num_frames=1, seed=0, echo=SkinEcho(**limbs), motions=STILL)
        return made.adc.samples.astype(complex)

    as_it_is, none = samples(), -200.0
    for limb, documented_db in (("legs_db", -6.0), ("arms_db", 2.0)):
        others, as_the_trunk = samples(**{limb: none}), samples(**{limb: 0.0})
        power, plain = (float(np.sum(np.abs(one - others) ** 2)) for one in (as_it_is, as_the_trunk))
        assert 10 * np.log10(power / plain) == pytest.approx(documented_db, abs=0.1)


def test_a_shin_has_the_cross_section_of_a_tapered_cylinder_with_the_skin_of_the_primer():
    """Its direct echoes, turned about by the radar equation, and the primer's formula summed over the surface."""
    simulator = Simulator(scene_of((floor(-8.0),)), AWR1843, IDEAL)
    person = standing_person((0.0, 2.0, -0.3))  # shins at the radar's height, and little off its axis
    joints_m = simulator._joints_at_nodes(person, np.arange(1))
    paths = BodyPaths(simulator.room, ScatteringBody(0, 1.75, 60_000), simulator.clock, joints_m)
    shins = [k for k, one in enumerate(CAPSULES) if (part_of(one.start), part_of(one.end)) == ("knee", "ankle")]
    middle = (0.2, 0.8)  # of its length, clear of knee and foot
    own = np.isin(paths.body.part, shins) & (paths.body.along > middle[0]) & (paths.body.along < middle[1])
    peak_mw = 10 ** ((AWR1843.tx_power_dbm + 2 * AWR1843.antenna_gain_dbi) / 10)
    of_1_m2 = peak_mw * AWR1843.wavelength_m**2 / ((4 * np.pi) ** 3 * paths.distance_m[0, own] ** 4)
    got_m2 = (np.abs(paths.direct[0, own]) ** 2 * paths.visible[0, own] / of_1_m2).sum()

    along, around = np.meshgrid(np.linspace(*middle, 25), np.linspace(0, 2 * np.pi, 721)[:-1], indexing="ij")
    expected_m2 = 0.0
    for side in ("left", "right"):
        knee, ankle = (np.add(STANDING_M[f"{side}_{name}"], (0.0, 2.0, -0.3)) for name in ("knee", "ankle"))
        length_m = float(np.linalg.norm(ankle - knee))
        axis, radius = (ankle - knee) / length_m, 0.055 + (0.038 - 0.055) * along
        across = np.array([1.0, 0.0, 0.0])
        ahead = np.cross(axis, across)
        outward = np.cos(around)[..., None] * across + np.sin(around)[..., None] * ahead
        normal = outward + (0.055 - 0.038) / length_m * axis
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        place = knee + along[..., None] * length_m * axis + radius[..., None] * outward
        cos = (normal * -place).sum(-1) / np.linalg.norm(place, axis=-1)
        area_m2 = radius * length_m * 2 * np.pi * (middle[1] - middle[0]) / along.size
        lit, tan2 = np.clip(cos, 1e-3, 1), 1 / np.clip(cos, 1e-3, 1) ** 2 - 1
        patch = 0.14 / (2 * 0.1**2 * lit**4) * np.exp(-tan2 / (2 * 0.1**2)) + 4 * 0.01 * lit**2
        expected_m2 += 10**-0.6 * float((patch * area_m2 * (cos > 0)).sum())
    assert 10 * np.log10(got_m2 / expected_m2) == pytest.approx(0.0, abs=0.9)
