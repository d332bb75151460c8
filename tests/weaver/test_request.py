"""A request is checked before any work, and its sentences are parsed once."""

from dataclasses import replace
from typing import Any

import pytest

from mmweaver.core.boards import AWR1843, MMMESH
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.weaver import parsed_request as module
from mmweaver.weaver.parsed_request import MAX_FRAMES, ParsedRequest, parse
from mmweaver.weaver.request import Request

TEXT = "a person walks towards the radar"


def parse_request(radar: RadarConfig, text: str | list[str] | None = None, **asked: Any) -> ParsedRequest:
    return parse(Request(text=text, **asked), radar)


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"text": ""}, "empty"),
        ({"text": " \n"}, "empty"),
        ({"text": "walk " * 2000}, "10000 characters"),
        ({"text": "a person photosynthesises"}, "walk"),
        ({"text": "a person squats, then walks", "frames": 2}, r"at least 0\.6 s"),
        ({"frames": 20, "seconds": 2.0}, "one of them"),
        ({"seconds": -1.0}, "seconds must be"),
        ({"seconds": 300.0}, "2000 .* are made"),
        ({"frames": 0}, f"1 to {MAX_FRAMES}"),
        ({"frames": 1_000_000}, f"1 to {MAX_FRAMES}"),
        ({"fps": 0.0}, "fps"),
        ({"fps": float("nan")}, "fps"),
        ({"fps": 500.0}, "frame period"),
        ({"fps": 0.1, "frames": 100}, "600 s"),
        ({"seed": -1}, "seed"),
        ({"at": (float("nan"), 1.0)}, "two numbers"),
        ({"at": [(0.0, 1.0), (0.5, 1.0)]}, "at most 1 places"),
        ({"text": []}, "1 to 8 texts"),
        ({"text": [TEXT] * 9}, "1 to 8 texts"),
        ({"text": [TEXT, "a person photosynthesises"]}, "walk"),
        ({"text": [TEXT, "nobody"]}, "give it alone"),
        ({"text": "an empty room", "at": (0.0, 1.0)}, "leave out place"),
        ({"text": "nobody", "path_m": [(0.0, 1.0), (0.0, 2.0)]}, "leave out place"),
        ({"text": [TEXT, TEXT], "at": (0.0, 1.0)}, "list of at most 2 places"),
        ({"text": [TEXT, TEXT], "at": [None, (0.0, float("inf"))]}, "two numbers"),
    ],
)
def test_a_bad_request_is_refused_before_any_work(request_: dict, says: str):
    with pytest.raises(InputError, match=says):
        parse_request(AWR1843, **{"text": TEXT, **request_})


def test_an_empty_room_has_no_people_and_two_seconds():
    request = parse_request(AWR1843, text="An empty room.")
    assert (request.people, request.text, request.frames) == ((), "nobody", 20)
    assert (request.at, request.height_m, request.subject) == (None, None, None)
    assert parse_request(AWR1843, text=["nobody"], seconds=1.0).frames == 10
    with pytest.raises(InputError, match="generate --text nobody"):
        module.parsed_text("nobody")


def test_memory_is_asked_for_before_it_is_used():
    with pytest.raises(InputError, match=r"mmmesh.* 635 "):
        parse_request(MMMESH, text=TEXT, frames=MAX_FRAMES, keep_adc=True)
    parse_request(AWR1843, text=TEXT, frames=MAX_FRAMES, keep_adc=False)


@pytest.mark.parametrize("keep_adc", [False, True])
def test_by_default_as_much_is_made_as_may_be_asked_for(keep_adc: bool):
    """Of a motion that lasts longer than memory allows; a frame more is refused."""
    long = f"{TEXT} for 590 seconds"
    made = parse_request(MMMESH, text=long, keep_adc=keep_adc).frames
    values = MMMESH.num_samples if keep_adc else MMMESH.num_range_bins
    assert 8 * made * MMMESH.num_loops * MMMESH.num_antennas * values <= 2e9
    assert parse_request(MMMESH, text=TEXT, frames=made, keep_adc=keep_adc).frames == made
    with pytest.raises(InputError, match=f"memory; at most {made}|1 to {MAX_FRAMES}"):
        parse_request(MMMESH, text=TEXT, frames=made + 1, keep_adc=keep_adc)


def test_the_frame_rate_is_the_radars_own_unless_given():
    slow = replace(AWR1843, frame_period_s=0.2)
    assert parse_request(slow, text=TEXT).config.frame_period_s == 0.2
    assert parse_request(slow, text=TEXT, fps=10.0).config == AWR1843


def test_one_person_and_several():
    one = parse_request(AWR1843, TEXT, at=(0.5, 2.0), height_m=1.8)
    assert (one.text, one.at, one.height_m) == (TEXT, (0.5, 2.0), 1.8)
    assert one.duration_s == pytest.approx(2.0)
    assert one.people[0].plan is not None
    assert one.people[0].plan.steps[-1].end_s == pytest.approx(2.0)
    two = parse_request(AWR1843, [TEXT, "a person waves"], at=[None, (0.5, 2.0)])
    assert (two.text, two.at, two.height_m) == ([TEXT, "a person waves"], [None, (0.5, 2.0)], None)
    with pytest.raises(InputError, match="--height"):
        parse_request(AWR1843, [TEXT, TEXT], height_m=1.8)
    with pytest.raises(InputError, match="1 heights, not 2"):
        parse_request(AWR1843, TEXT, height_m=[1.8, 1.7])


def test_the_sentence_decides_how_long_it_takes():
    assert parse_request(AWR1843, "a person nods").duration_s == pytest.approx(2.0)  # at least
    long = parse_request(AWR1843, ["a person walks, sits down, drinks and stands up", "a person waves"])
    plans = [person.plan for person in long.people if person.plan is not None]
    assert long.duration_s > 7.0
    assert {plan.duration_s for plan in plans} == {long.duration_s}
    assert parse_request(AWR1843, TEXT, seconds=3.0).frames == 30
    assert parse_request(AWR1843, TEXT, seconds=3.0, fps=20.0).frames == 60


def test_a_path_is_for_somebody_who_walks():
    asked = parse_request(AWR1843, "a person walks, then waves", path_m=[(0.0, 3.0), (0.0, 1.5)])
    plan = asked.people[0].plan
    assert plan is not None
    assert plan.steps[0].route_m == ((0.0, 3.0), (0.0, 1.5))
    with pytest.raises(InputError, match="--path"):
        parse_request(AWR1843, "a person waves", path_m=[(0.0, 3.0), (0.0, 1.5)])
    with pytest.raises(InputError, match=r"two points.*0,3 0,1\.5"):
        parse_request(AWR1843, TEXT, path_m=[(0.0, 3.0)])
    with pytest.raises(InputError, match=r"0\.10 m.*0\.35 m"):
        parse_request(AWR1843, TEXT, path_m=[(0.0, 3.0), (0.0, 2.9)])


def test_a_path_is_as_long_as_it_is_and_its_corners_take_time():
    bent = parse_request(AWR1843, "a person walks", path_m=[(0.0, 3.0), (0.0, 2.0), (1.2, 2.0)]).people[0].plan
    straight = parse_request(AWR1843, "a person walks", path_m=[(0.0, 3.0), (0.0, 0.8)]).people[0].plan
    assert bent is not None
    assert straight is not None
    assert bent.clauses[0].shown == straight.clauses[0].shown == "walking 2.2 m"
    assert bent.duration_s > straight.duration_s + 0.3


def test_a_path_that_leads_elsewhere_than_the_sentence_is_said():
    path = [(0.0, 3.0), (0.0, 1.5)]
    for text, status in (("a person walks", "done"), ("a person walks backwards", "approximated")):
        plan = parse_request(AWR1843, text, path_m=path).people[0].plan
        assert plan is not None
        assert [clause.status for clause in plan.clauses] == [status]
