"""Paths over two people: lengths and rates, their level, and that neither a single person nor first order has them."""

from dataclasses import replace

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import PoseSequence
from mmweaver.propagation.body_model import body_of
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.paths import Interaction, Paths
from mmweaver.propagation.ray_traced import PeoplePaths, Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.skin_scattering import LAMBERT, SkinEcho
from mmweaver.propagation.static_paths import Propagation
from tests.rooms import back_wall, scene_of, standing_person

APART_M = np.array([-0.9, 3.0, -1.1]), np.array([0.4, 3.2, -1.1])
VELOCITY = np.array([0.4, -1.1, 0.0]), np.array([-0.7, 0.2, 0.0])


def people(
    order: tuple[int, ...] = (0, 1), propagation: Propagation | None = None, subject: int = 0, echo: SkinEcho = LAMBERT
) -> PeoplePaths:
    simulator = Simulator(scene_of((back_wall(6.0),)), AWR1843, IDEAL, propagation=propagation)
    poses: list[PoseSequence] = [
        replace(standing_person(tuple(APART_M[who]), tuple(VELOCITY[who])), subject=subject + who) for who in order
    ]
    joints_m = [simulator._joints_at_nodes(pose, np.arange(2)) for pose in poses]
    return PeoplePaths(simulator.room, [body_of(pose, echo=echo) for pose in poses], simulator.clock, joints_m)


def over_both(found: PeoplePaths, frame: int = 0) -> Paths:
    (paths,) = found.paths(frame)
    return paths[paths.interaction == int(Interaction.BODY_BODY)]


def test_lengths_and_rates_are_those_over_both():
    found = people()
    between = found.between[0]
    for frame in range(2):
        paths, pairs = over_both(found, frame), between.pairs[frame]
        a = between.first.middles_m(frame)[pairs.first]
        b = between.second.middles_m(frame)[pairs.second]
        ways = a, b, b - a
        speeds = VELOCITY[0], VELOCITY[1], VELOCITY[1] - VELOCITY[0]
        assert len(paths) == len(a) > 10
        assert paths.is_reciprocal.all()
        assert np.allclose(paths.length_m.numpy(), sum(np.linalg.norm(way, axis=1) for way in ways), atol=1e-6)
        rates = sum(
            (way / np.linalg.norm(way, axis=1)[:, None]) @ speed for way, speed in zip(ways, speeds, strict=True)
        )
        assert np.allclose(paths.rate_mps.numpy(), rates, atol=2e-3)


def test_the_level_is_that_of_all_pairs_of_skin_points():
    """Parts of bodies stand for their skin: within 1.5 dB of the sum over every pair of points, room aside."""
    assert abs(level_over_all_pairs_db(people())) < 1.5


def test_specular_skin_shines_on_others_whoever_they_are():
    """Of few points of skin, some people have none that faces half way to the other: up to 25 dB were missing."""
    found = [level_over_all_pairs_db(people(subject=subject, echo=SkinEcho())) for subject in range(0, 12, 2)]
    assert np.abs(found).max() < 4.0
    assert abs(np.mean(found)) < 2.0


def level_over_all_pairs_db(found: PeoplePaths) -> float:
    """Power over both people, relative to the sum over every pair of their visible skin points."""
    a, b = found.each
    place = [each.posed.place_m[0][each.visible[0]] for each in (a, b)]
    leg = place[1][None] - place[0][:, None]
    leg_m = np.linalg.norm(leg, axis=2)
    ways = leg / leg_m[..., None], -leg.transpose(1, 0, 2) / leg_m.T[..., None]
    sigma = [skin_towards(each, way) for each, way in zip((a, b), ways, strict=True)]
    level = [each.gain * each.pattern(-each.towards[0][each.visible[0]])[:, None] ** 2 for each in (a, b)]
    loss = 4 * np.pi * (a.distance_m[0][a.visible[0]][:, None] * leg_m * b.distance_m[0][b.visible[0]]) ** 2
    expected = (level[0] * level[1].T * sigma[0] * sigma[1].T / loss).sum()
    own = (over_both(found).amplitude.abs().numpy() ** 2).sum()
    return float(10 * np.log10(own / expected))


def skin_towards(person: BodyPaths, out: np.ndarray) -> np.ndarray:
    """Cross sections (point, other) of visible skin from the radar into unit directions (point, other, 3)."""
    seen = person.visible[0]
    normal, towards, cos_in = person.posed.normal[0][seen], person.towards[0][seen], person.cos[0][seen]
    cos_out = np.einsum("poi,pi->po", out, normal)
    half = np.sqrt(np.maximum(2 + 2 * np.einsum("poi,pi->po", out, towards), 1e-9))
    cos_half = np.clip((cos_in[:, None] + cos_out) / half, -1, 1)
    brightness = person.body.brightness[seen]
    return person.body.echo.bistatic(cos_in[:, None], cos_out, cos_half) * (person.body.area_m2 * brightness)[:, None]


def test_a_person_alone_and_first_order_have_none():
    assert not people((0,)).between
    assert not people(propagation=Propagation(bounces=1)).between
