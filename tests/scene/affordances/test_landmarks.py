"""Tables, doors, windows and beds, from a mask and from depth alone."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import LANDMARK_KINDS, Scene
from mmweaver.motion.language.lexicon import TARGETS
from mmweaver.scene.affordances.landmarks import add_landmarks
from mmweaver.scene.procedural.procedural_room import ProceduralRoom, make_room
from mmweaver.scene.reconstruction import reconstruct


@pytest.fixture(scope="module")
def office() -> ProceduralRoom:
    return make_room("office", 2, 21)


def _near(scene: Scene, room: ProceduralRoom, kind: str) -> list[float]:
    """Distance of each landmark of a kind to the nearest true one, metres."""
    places = [mark.position_m[:2] for mark in room.landmarks if mark.kind == kind]
    found = [mark.position_m[:2] for mark in scene.landmarks if mark.kind == kind]
    return [float(min(np.hypot(*(place - one)) for place in places)) for one in found]


@pytest.mark.parametrize("with_mask", [True, False])
def test_doors_and_tables_are_found_at_their_true_places(office: ProceduralRoom, with_mask: bool):
    photo = office.photo("lamps", noise=True)
    scene = reconstruct(photo if with_mask else dataclasses.replace(photo, classes=None))
    for kind in ("door", "table"):
        distances = _near(scene, office, kind)
        assert distances, kind
        assert max(distances) < 0.6, kind
    order = [(mark.kind, float(np.hypot(*mark.position_m[:2]))) for mark in scene.landmarks]
    assert order == sorted(order), "by kind, the nearest first"


def test_approaches_are_free_and_face_the_landmark(office: ProceduralRoom):
    scene = reconstruct(office.photo("lamps"))
    space = scene.free_space
    for mark in scene.landmarks:
        column = int(np.argmin(np.abs(space.x_m - mark.approach_m[0])))
        row = int(np.argmin(np.abs(space.y_m - mark.approach_m[1])))
        assert space.is_free[row, column]
        gap = mark.position_m[:2] - np.array(mark.approach_m)
        assert np.angle(np.exp(1j * (np.arctan2(gap[1], gap[0]) - mark.facing_rad))) == pytest.approx(0, abs=1e-6)


def test_given_landmarks_replace_those_found(office: ProceduralRoom):
    scene = reconstruct(office.photo("lamps"))
    given = add_landmarks(scene, [("door", (0.2, 2.0))])
    (door,) = [mark for mark in given.landmarks if mark.kind == "door"]
    assert door.position_m[:2] == pytest.approx([0.2, 2.0])
    assert np.hypot(*(np.array(door.approach_m) - [0.2, 2.0])) < 1.2
    assert [mark.kind for mark in given.landmarks].count("table") == [mark.kind for mark in scene.landmarks].count(
        "table"
    )
    assert "given by the user" in given.assumptions[-1]
    with pytest.raises(InputError, match=r"'swing'.*door, window"):
        add_landmarks(scene, [("swing", (0.2, 2.0))])
    with pytest.raises(InputError, match=r"0\.2,-2"):
        add_landmarks(scene, [("door", (0.2, -2.0))])


def test_whatever_a_sentence_can_go_to_can_be_given():
    assert set(TARGETS.values()) == set(LANDMARK_KINDS)
