"""Words of the command line become values, or an error that says how to write them."""

import argparse

import pytest

from mmweaver.cli.arguments import Parser, glued, landmark, number, place, radar_pose, transmitters, whole
from mmweaver.cli.main import build_parser
from mmweaver.core.errors import InputError


def test_values():
    assert place("-0.5,2") == (-0.5, 2.0)
    assert transmitters("0,2,1") == (0, 2, 1)
    assert landmark("door=-0.9,2.8") == ("door", (-0.9, 2.8))
    assert (whole("7"), number("2.5")) == (7, 2.5)


@pytest.mark.parametrize(
    ("kind", "word"),
    [
        (place, "1"),
        (place, "1,2,3"),
        (place, "a,b"),
        (transmitters, "0;2"),
        (landmark, "door"),
        (radar_pose, "0,0,0"),
        (whole, "1.5"),
        (number, "x"),
    ],
)
def test_a_bad_word_is_named(kind, word: str):
    with pytest.raises(argparse.ArgumentTypeError, match=word):
        kind(word)


def test_a_place_may_begin_with_a_minus():
    assert glued(["--at", "-.5,2", "--seed", "-1"]) == ["--at=-.5,2", "--seed", "-1"]
    assert glued(["--at", "--frames"]) == ["--at", "--frames"]
    assert glued(["--at"]) == ["--at"]


def test_the_parser_raises_rather_than_exits():
    with pytest.raises(InputError, match="--help"):
        Parser(prog="x").parse_args(["--nope"])


def test_an_unknown_command_or_choice_is_said_with_the_nearest():
    with pytest.raises(InputError, match=r"'trian' is unknown; did you mean train\?"):
        build_parser().parse_args(["trian"])
    with pytest.raises(InputError, match=r"'weavr' is unknown; did you mean weaver\?"):
        build_parser().parse_args(["train", "weavr", "--out", "x"])
    with pytest.raises(InputError, match="choose from 'generate'"):
        build_parser().parse_args(["bench"])


def test_an_unknown_option_is_said_by_its_command_with_the_nearest():
    with pytest.raises(InputError, match=r"--sedd 3; did you mean --seed\? \(see mmweaver generate --help\)"):
        build_parser().parse_args(["generate", "--demo", "--sedd", "3"])
