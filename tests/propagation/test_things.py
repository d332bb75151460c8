"""Reflectors against the radar equation, and things that move: where they are, how fast, and what is reported."""

import numpy as np
import pytest

from mmweaver import Weaver
from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.targets import Reflector, Thing, thing_rows, things_of_text
from mmweaver.propagation.antenna import pattern_db
from mmweaver.propagation.things import MovingThing, reflector_paths

PLACES = ((0.0, 0.8, 0.0), (0.2, 0.7, 0.1), (0.4, 1.5, -0.2), (-0.6, 2.0, 0.4), (0.0, 3.0, -0.5))
SECONDS = np.arange(0, 20, 0.005)


@pytest.mark.parametrize("preset", sorted(PRESETS))
def test_a_reflector_returns_what_the_radar_equation_says(preset: str):
    """P = Pt G^2 lambda^2 sigma / ((4 pi)^3 R^4), minus the pattern both ways; within 0.5 dB at five places."""
    radar = PRESETS[preset]
    for place in PLACES:
        range_m = float(np.linalg.norm(place))
        loss_db = float(pattern_db(np.array([place]) / range_m, radar)[0])
        expected = radar.tx_power_dbm + 2 * radar.antenna_gain_dbi - 2 * loss_db + 10.0
        expected += 20 * np.log10(radar.wavelength_m) - 30 * np.log10(4 * np.pi) - 40 * np.log10(range_m)
        paths = reflector_paths([Reflector(place_m=place, dbsm=10.0)], RadarPose(), radar)
        assert 20 * np.log10(np.abs(paths.amplitude.numpy()[0])) == pytest.approx(expected, abs=0.5)


@pytest.mark.parametrize("method", ["physics", "weaver"])
def test_a_reflector_stands_in_the_cube_with_its_power(method: str):
    """The peak of the cube: the amplitude of the windowed spectrum is that of the path."""
    weaver = Weaver(method=method, radar="xwr1443boost")
    room = weaver.sample_room()
    target = Reflector(place_m=(0.0, 2.0, 0.0), dbsm=25.0)
    made = weaver.generate(room, "nobody", frames=1, seed=0, board="ideal", reflectors=[target]).cube
    at = int(np.argmin(np.abs(made.grid.range_m - 2.0)))
    zero = made.config.num_loops // 2
    power = (np.abs(made.values[0, at - 2 : at + 3, zero - 1 : zero + 2]) ** 2).sum(axis=(0, 1)).mean()
    path = np.abs(reflector_paths([target], RadarPose(), made.config).amplitude.numpy()[0]) ** 2
    # energy of a Hann window's main lobe over its peak, in range and in Doppler: 1.5 each
    assert 10 * np.log10(power / (path * 1.5**2)) == pytest.approx(0, abs=0.6)


def test_a_corner_loses_half_its_power_twenty_degrees_off_and_a_sphere_nothing():
    aside = RadarPose(x_m=2.0 * np.tan(np.radians(20)), yaw_deg=-20.0)
    levels = {}
    for shape in ("corner", "sphere"):
        target = Reflector(place_m=(0.0, 2.0, 0.0), dbsm=10.0, shape=shape)
        each = [reflector_paths([target], pose, PRESETS["awr1843"]).amplitude.abs()[0] for pose in (RadarPose(), aside)]
        farther_db = 40 * np.log10(1 / np.cos(np.radians(20)))
        levels[shape] = 20 * np.log10(float(each[1] / each[0])) + farther_db
    assert levels["sphere"] == pytest.approx(0, abs=0.05)
    assert levels["corner"] == pytest.approx(-3, abs=0.05)


@pytest.mark.parametrize("kind", sorted(thing_rows()))
def test_things_move_smoothly_within_the_speeds_of_their_row(kind: str):
    one, other = (MovingThing(Thing(kind=kind, place_m=(0.3, 2.0), seed=seed), -1.2) for seed in (0, 1))
    places = one.places(SECONDS)
    speed = np.linalg.norm(np.diff(places, axis=0), axis=-1) / 0.005
    fastest = {"fan": 18.0, "ceiling_fan": 14.0, "dog": 4.5, "cat": 3.0, "door": 1.0, "vacuum": 2.6}
    assert 1e-3 < speed.max() < fastest.get(kind, 0.5)
    assert np.abs(np.diff(speed, axis=0)).max() < 0.35 * max(speed.max(), 0.1)  # nothing jumps
    assert np.array_equal(one.places(SECONDS[100:200]), places[100:200])  # however time is cut
    assert not np.allclose(other.places(SECONDS[:1]), places[:1], atol=1e-6)
    assert places[..., 2].min() > -1.25
    assert np.hypot(*(places[..., :2].mean(axis=(0, 1)) - (0.3, 2.0))) < 0.6


def test_a_fan_beats_the_air_at_its_rate_and_is_reported():
    weaver = Weaver(method="weaver", radar="xwr1443boost")
    room = weaver.sample_room()
    made = weaver.generate(room, "nobody while a ceiling fan is running", seed=2, frames=20, board="ideal")
    (thing,) = made.things
    assert thing.kind == made.meta["things"][0]["kind"] == "ceiling_fan"
    assert 1.7 <= made.meta["things"][0]["rate_hz"] <= 3.5
    without = weaver.generate(room, "nobody", seed=2, frames=20, board="ideal")
    changed = (np.abs(made.cube.values - without.cube.values) ** 2).mean(axis=(0, 3))
    velocity = made.cube.grid.radial_velocity_mps
    near = np.abs(made.cube.grid.range_m - np.linalg.norm(thing.place_m[0])) < 0.9
    assert changed[near].sum() > 0.9 * changed.sum()
    spread = np.sqrt((changed.sum(axis=0) * velocity**2).sum() / changed.sum())
    assert 0.5 < spread < 4.4


@pytest.mark.parametrize(
    ("text", "rest", "kinds"),
    [
        ("a person sits while a fan is running", "a person sits", ("fan",)),
        ("a person waves, a cat walks by", "a person waves", ("cat",)),
        ("a person walks to the door", "a person walks to the door", ()),
        ("a person stands while the curtain is blowing in the wind and a dog walks past", "a person stands",
         ("curtain", "dog")),
        ("somebody falls while a robot vacuum is cleaning the floor, then gets up", "somebody falls, then gets up",
         ("vacuum",)),
    ],
)  # fmt: skip
def test_things_are_taken_out_of_sentences(text: str, rest: str, kinds: tuple[str, ...]):
    assert things_of_text(text) == (rest, kinds)


@pytest.mark.parametrize("words", ["fan=1", "fox=1,2", "fan=1,x", "fan=1,1000"])
def test_wrong_things_are_refused(words: str):
    with pytest.raises(InputError):
        Thing.of_words(words)


@pytest.mark.parametrize("words", ["1,2,3", "1,2,3,99", "1,2,3,4,cube", "a,2,3,4"])
def test_wrong_reflectors_are_refused(words: str):
    with pytest.raises(InputError):
        Reflector.of_words(words)


def test_words_are_read_back():
    for one in (Reflector(place_m=(0.5, 2.0, -0.1), dbsm=3.0), Thing(kind="fan", place_m=(1.0, 2.5), heading_rad=0.5)):
        assert type(one).of_words(one.words).words == one.words
