"""What the page asks for is checked before anything is done."""

import re
import shlex
from time import process_time
from typing import Any

import pytest

from mmweaver.cli.arguments import parsed
from mmweaver.cli.main import parser_of
from mmweaver.core.errors import InputError
from mmweaver.studio.schemas import Form
from mmweaver.weaver.request import Request

GOOD = {"room": "demo", "text": ["a person waves"], "radar": "awr1843", "method": "auto", "seed": 3, "at": [0.2, 2.0]}


def test_a_request_is_read():
    asked = Form.of(GOOD)
    assert asked.request == Request(text="a person waves", seed=3, at=(0.2, 2.0))


def test_a_path_has_as_many_places_as_the_refusal_says():
    place = [0.5, 2]
    with pytest.raises(InputError) as refused:
        Form.of({**GOOD, "path": [place] * 10**4})
    fewest, most = map(int, re.findall(r"\d+", str(refused.value)))
    assert Form.of({**GOOD, "path": [place] * most}).request.path_m == ((0.5, 2.0),) * most
    assert len(Form.of({**GOOD, "path": [place] * fewest}).request.path_m or ()) == fewest
    for number in (fewest - 1, most + 1):
        with pytest.raises(InputError):
            Form.of({**GOOD, "path": [place] * number})


def test_the_first_of_two_people_starts_at_the_place():
    asked = Form.of({**GOOD, "text": ["a person waves", "a person sits"]})
    assert asked.request.at == [(0.2, 2.0), None]


def test_the_command_line_asks_for_the_same():
    words = shlex.split(Form.of({**GOOD, "text": ["it's a person", "another"], "at": [-0.2, 2.0]}).command(["--demo"]))
    arguments: Any = parsed(*parser_of("generate"), words[1:])
    assert arguments.demo
    assert arguments.text == ["it's a person", "another"]
    assert arguments.at == [(-0.2, 2.0)]
    assert arguments.seed == 3


def test_the_python_is_python():
    compile(Form.of({**GOOD, "text": ['it\'s "one"']}).python("sample_room()"), "<python>", "exec")


@pytest.mark.parametrize(
    "wrong",
    [
        None, [], {**GOOD, "text": []}, {**GOOD, "text": [1]}, {**GOOD, "text": "x" * 501}, {**GOOD, "seed": -1},
        {**GOOD, "seed": True}, {**GOOD, "seed": 1.5}, {**GOOD, "at": [1]},
        {**GOOD, "at": "12"}, {**GOOD, "at": {"0": 1, "1": 2}},
        {**GOOD, "path": [[0, 1]]}, {**GOOD, "path": [[0, 1], [0, "b"]]},
        {**GOOD, "path": "ab"},
    ],
)  # fmt: skip
def test_anything_else_is_refused(wrong: Any):
    with pytest.raises(InputError):
        Form.of(wrong)


def test_an_endless_path_is_refused_at_once():
    begun = process_time()
    for path in ([[0.1, 2.0]] * 1_000_000, "0.1,2.0 " * 1_000_000):
        with pytest.raises(InputError, match="200"):
            Form.of({"room": "demo", "text": ["a person walks"], "path": path})
    assert process_time() - begun < 0.1
