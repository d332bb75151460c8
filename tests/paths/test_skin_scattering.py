"""The skin's lobe: energy, reciprocity, what a sphere returns, and a person's cross-section."""

import numpy as np
import pytest

from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.paths.body_model import ScatteringBody
from mmweaver.paths.skin_scattering import LAMBERT, SkinEcho
from tests.rooms import standing_person


def test_a_wrinkled_sphere_returns_what_a_smooth_one_does():
    """Geometric optics: pi a^2 |Gamma|^2, whatever the wrinkles, if they are gentle."""
    angle = np.linspace(0, np.pi / 2, 20001)
    ring = 2 * np.pi * np.sin(angle) * (angle[1] - angle[0])  # of a sphere of radius 1
    for slope in (0.03, 0.1):
        total = (SkinEcho(reflectivity=0.5, slope=slope, albedo=0.0).back(np.cos(angle)) * ring).sum()
        assert total == pytest.approx(0.5 * np.pi, rel=0.05)


def test_lambert_is_four_albedo_cos_squared():
    cos = np.array([-0.5, 0.0, 0.3, 1.0])
    assert LAMBERT.back(cos) == pytest.approx([0.0, 0.0, 4 * 0.18 * 0.09, 4 * 0.18])


def test_in_and_out_change_places_and_the_mirror_direction_shines():
    echo = SkinEcho()
    cos_in, cos_out, half = np.array([0.9]), np.array([0.4]), np.array([0.8])
    assert echo.over(cos_in, cos_out, half) == pytest.approx(echo.over(cos_out, cos_in, half))
    sixty = np.array([0.5])
    assert echo.over(sixty, sixty, np.array([1.0]))[0] > 100 * echo.back(sixty)[0]
    assert echo.over(sixty, -sixty, np.array([1.0]))[0] == 0


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
        total.append((body.echo.back(skin.normal[0] @ towards) * clear * body.brightness).sum() * body.area_m2)
    assert -8 < 10 * np.log10(np.mean(total)) < -4


def test_only_skin_that_returns_nothing_is_left_out():
    assert SkinEcho().least_cos == LAMBERT.least_cos == 0.02
    for slope in (0.05, 0.2):
        sharp = SkinEcho(slope=slope, albedo=0.0)
        edge = np.array([sharp.least_cos])
        assert sharp.back(edge) * edge**4 == pytest.approx(1e-6 * sharp.back(np.array([1.0])))
