"""Words of the command line become the options of a command, or an error that says how to write them."""

from typing import Any

import pytest

from mmweaver.cli.arguments import RENAMED, parsed
from mmweaver.cli.main import COMMANDS, parser_of
from mmweaver.core.errors import InputError
from mmweaver.core.options import command_words, option_name, options_of
from mmweaver.core.placed_thing import PlacedThing


def options(*argv: str) -> Any:
    return parsed(*parser_of(argv[0]), list(argv))


def test_values():
    found = options(
        "generate", "--at", "-0.5,2", "--tx-order", "0,2,1", "--landmark", "door=-0.9,2.8", "--path", "0,3 1,2"
    )
    assert (found.at, found.tx_order, found.landmark) == ([(-0.5, 2.0)], (0, 2, 1), [PlacedThing("door", (-0.9, 2.8))])
    assert found.path_m == ((0.0, 3.0), (1.0, 2.0))
    assert options("generate", "--furnish", "bed=0.5,2,180").furnish == [PlacedThing("bed", (0.5, 2.0), 180.0)]
    assert options("generate", "--at", "-.5,2", "--seed", "-1").seed == -1
    assert options("decompress", "a.mmw", "-o", "b.npz", "--frames", "3:").frames == slice(3, None)


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("--at", "1"), ("--at", "1,2,3"), ("--at", "a,b"), ("--tx-order", "0;2"), ("--landmark", "door"),
        ("--radar-pose", "0,0,0"), ("--seed", "1.5"), ("--fps", "x"), ("--fps", "nan"), ("--seed", str(2**63)),
    ],
)  # fmt: skip
def test_a_bad_word_is_named_with_its_option(name: str, word: str):
    with pytest.raises(InputError) as refused:
        options("generate", name, word)
    assert name in str(refused.value)
    assert word in str(refused.value)


def test_options_become_the_words_that_make_them():
    argv = ["--demo", "--text=one", "--text=two", "--at=-0.5,2.0", "--heading=-20.5", "--path=0.0,3.0 1.0,2.0", "--bin"]
    argv += ["--furnish=bed=0.5,2.0,180.0", "--missing=refuse", "--strict"]
    found = options("generate", *argv, "--radar-pose", "0.5,0,0.2,-30,10")
    assert options("generate", *command_words(found)) == found


@pytest.mark.parametrize(
    ("argv", "says"),
    [
        (["trian"], ["'trian'", "train?"]),
        (["train", "weavr", "--out", "x"], ["'weavr'", "weaver?"]),
        (["bench"], ["'generate'"]),
        (["generate", "--demo", "--sedd", "3"], ["--sedd", "--seed?", "mmweaver generate --help"]),
        (["points", "x.dat"], ["out"]),
        (["generate", "--demo", "--sam", "sam"], ["--sam", "sam=NAME"]),
    ],
)
def test_a_wrong_word_is_said_with_the_nearest(argv: list[str], says: list[str]):
    with pytest.raises(InputError) as refused:
        options(*argv)
    for word in says:
        assert word in str(refused.value)


def test_old_names_warn_and_work(capsys: pytest.CaptureFixture[str]):
    found = options("generate", "--capture", "scan/", "--further-photos=auto", "--subframe", "1", "--motion-up", "-z")
    assert (str(found.room), found.extra_views) == ("scan", "auto")
    assert (found.radar_set, found.motion_set) == (["subframe=1"], ["up=-z"])
    assert [line.split()[1] for line in capsys.readouterr().err.splitlines()] == [
        "--capture", "--further-photos", "--subframe", "--motion-up",
    ]  # fmt: skip


def test_every_old_name_has_a_name_today():
    known = {f"--{option_name(one)}" for _, kind in parser_of(*COMMANDS)[1].values() for one in options_of(kind)
             if not one.metadata.get("positional")}  # fmt: skip
    for old, new in RENAMED.items():
        assert old not in known
        assert not new.startswith("--") or new.split("=")[0] in known, old


def test_names_are_few():
    known = {option_name(one) for _, kind in parser_of(*COMMANDS)[1].values() for one in options_of(kind)
             if not one.metadata.get("positional")}  # fmt: skip
    assert len(known | {"help", "help-all"}) <= 110, sorted(known)
