"""Reflection coefficients against the figures of ITU-R P.2040-3 and against theory."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.propagation.materials import MATERIALS, reflection, relative_permittivity, slab_echoes, transmission


def level_db(name: str, cos: float, polarisation: str = "te") -> float:
    return 20 * np.log10(abs(reflection(MATERIALS[name], np.array([cos]), 77e9, polarisation=polarisation)[0]))


@pytest.mark.parametrize(("name", "expected_db"), [("concrete", -8), ("metal", 0)])
def test_thick_materials_straight_on(name: str, expected_db: float):
    """Thick lossy slabs act as half spaces: |1 - sqrt(eps)| / |1 + sqrt(eps)|."""
    assert level_db(name, 1.0) == pytest.approx(expected_db, abs=0.7)
    root = np.sqrt(relative_permittivity(MATERIALS[name], 77e9))
    assert level_db(name, 1.0) == pytest.approx(20 * np.log10(abs((1 - root) / (1 + root))), abs=0.7)


@pytest.mark.parametrize("name", list(MATERIALS))
@pytest.mark.parametrize("polarisation", ["te", "tm"])
def test_no_face_throws_back_more_than_it_gets(name: str, polarisation: str):
    gamma = reflection(MATERIALS[name], np.linspace(0.001, 1, 200), 77e9, polarisation=polarisation)
    assert np.abs(gamma).max() <= 1 + 1e-9


def test_both_polarisations_agree_straight_on():
    for material in MATERIALS.values():
        te, tm = (abs(reflection(material, np.ones(1), 77e9, polarisation=p)[0]) for p in ("te", "tm"))
        assert te == pytest.approx(tm, rel=1e-6)


def test_brewster_angle_is_seen_by_tm_alone():
    cos_brewster = np.cos(np.arctan(np.sqrt(5.24)))
    assert level_db("concrete", cos_brewster, "tm") < -25
    assert level_db("concrete", cos_brewster, "te") > -4


def test_grazing_is_total():
    assert level_db("plasterboard", 0.005) > -0.5


@pytest.mark.parametrize("name", list(MATERIALS))
@pytest.mark.parametrize("polarisation", ["te", "tm"])
def test_the_echoes_of_a_slab_are_its_reflection_over_the_band(name: str, polarisation: str):
    """Exact at the centre; over 3.4 GHz within 2 % of the wave, where the centre's value alone is up to 30 % off."""
    material, cos, centre_hz = MATERIALS[name], np.array([1.0, 0.8, 0.5, 0.2]), 78.7e9
    echoes = slab_echoes(material, cos, centre_hz, polarisation=polarisation, most=3)
    for frequency_hz, bound in ((centre_hz, 1e-9), *((one, 0.02) for one in np.linspace(77e9, 80.4e9, 9))):
        exact = reflection(material, cos, frequency_hz, polarisation=polarisation)
        assert np.abs(echoes.value(frequency_hz) - exact.conj()).max() < bound
    twice = echoes.doubled.value(79e9)
    assert np.allclose(twice, echoes.value(79e9) ** 2)


def test_what_a_lossless_slab_does_not_reflect_goes_through():
    clear = replace(MATERIALS["glass"], c=0.0)
    for cos in (1.0, 0.5):
        for polarisation in ("te", "tm"):
            shares = [of(clear, np.array([cos]), 77e9, polarisation=polarisation) for of in (transmission, reflection)]
            assert sum(np.abs(share[0]) ** 2 for share in shares) == pytest.approx(1.0)


@pytest.mark.parametrize(("name", "amplitude"), [("plasterboard", 0.454), ("metal", 0.0), ("concrete", 0.0)])
def test_one_way_through_a_slab(name: str, amplitude: float):
    """Plasterboard takes 7 dB: what lies behind it returns 14 dB fainter."""
    assert np.abs(transmission(MATERIALS[name], np.ones(1), 77e9)) == pytest.approx(amplitude, abs=0.02)
