"""Options from a TOML file, and the request.toml by which a run is repeated bit for bit."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mmweaver.cli.arguments import parsed, request_toml
from mmweaver.cli.main import main, parser_of
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.placed_thing import PlacedThing
from mmweaver.io.npz_files import read_radar_npz
from mmweaver.models.methods import Learned, Physics
from mmweaver.propagation.static_paths import Propagation
from mmweaver.weaver.front_door import Weaver

KINDS: Any = {"physics": Physics, "weaver": Learned}
REPEATED = ("radar.npz", "pose.npz", "points.npz", "radar.json", "request.toml")


def options(*argv: str) -> Any:
    return parsed(*parser_of(argv[0]), list(argv))


def test_a_run_is_repeated_by_its_request(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "board.json").write_text(AWR1843.to_json())
    monkeypatch.chdir(tmp_path)
    argv = ["generate", "--demo", "--text", "a person stands", "--at=-0.2,2.1", "--frames", "3", "--seed", "7"]
    argv += ["--radar", "board.json", "--height", "1.71", "--method", "physics", "--bin", "--tx-order", "1,0,2"]
    assert main([*argv, "--no-pictures", "--quiet", "--out", "out"]) == 0
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert main(["generate", "--config", "../out/request.toml", "--out", "again", "--quiet"]) == 0
    for name in (*REPEATED, "adc_data.bin"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "elsewhere" / "again" / name).read_bytes(), name
    assert main(["process", "../out/adc_data.bin", "--radar", "../out/radar.json", "--out", "cube", "--quiet"]) == 0
    assert main(["process", "--config", "cube/request.toml", "--out", "same", "--quiet"]) == 0
    assert Path("cube/radar.npz").read_bytes() == Path("same/radar.npz").read_bytes()


def test_every_kind_of_value_comes_back(tmp_path: Path):
    argv = [
        *["generate", "--rgb", "/a/rgb.png", "--text"],
        'a "b" \u00e9\n',
        *["--text", "c", "--at", "-0.1,2", "--at", "1,1.5"],
    ]
    argv += ["--landmark", "door=0.9,2.8", "--fps", "12.5", "--bin", "--heading", "-20.25", "--iq-order", "qi"]
    argv += ["--path", "0,3 -0.5,1", "--radar-pose", "0.5,0,0.2,-30,10", "--mesh-set", "up=y", "--tx-order", "0,2,1"]
    first = options(*argv)
    file = tmp_path / "request.toml"
    file.write_text(request_toml(first), encoding="utf-8")
    again = options("generate", "--config", str(file))
    assert first == replace(again, config=None)
    assert first.heading_rad == pytest.approx(math.radians(-110.25))
    assert first.landmark == [PlacedThing("door", (0.9, 2.8))]


def test_the_command_line_goes_before_the_file_and_paths_are_the_files(tmp_path: Path):
    file = tmp_path / "run.toml"
    file.write_text('rgb = "rgb.png"\ntext = ["one", "two"]\nframes = 7\nno_pictures = true\n')
    found = options("generate", "--config", str(file), "--text", "mine", "--frames=9")
    assert (found.text, found.frames, found.no_pictures) == (["mine"], 9, True)
    assert found.rgb == tmp_path / "rgb.png"


def test_a_file_of_0_2_is_read_and_its_old_names_are_warned_of_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "names.json").write_text("{}")
    (tmp_path / "run.toml").write_text(
        'mesh = "room.glb"\nmesh_eye = [0.5, 1.0, 1.2]\nmesh_materials = "names.json"\nrepeat = 3\n'
        'further_photos = "auto"\n'
    )
    found = options("generate", "--config", str(tmp_path / "run.toml"))
    assert found.room == tmp_path / "room.glb"
    assert found.mesh_set == ["eye=0.5,1.0,1.2", f"materials={tmp_path / 'names.json'}"]
    assert (found.per_class, found.extra_views) == (3, "auto")
    warned = capsys.readouterr().err.splitlines()
    assert len(warned) == 5
    assert any("--further-photos" in line and "--extra-views" in line for line in warned)


OLD_OPTIONS = tomllib.loads(Path(__file__).with_name("old_options.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("line", OLD_OPTIONS)
def test_an_old_option_of_a_file_is_read_and_warned_of_once(
    line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    (tmp_path / "names.json").write_text("{}")
    (tmp_path / "run.toml").write_text(f'command = "generate"\ndemo = true\nradar = "awr1843"\n{line}\nseed = 4\n')
    found = options("generate", "--config", str(tmp_path / "run.toml"))
    assert (found.demo, found.radar, found.seed) == (True, "awr1843", 4)
    name, value = OLD_OPTIONS[line].get("field"), OLD_OPTIONS[line].get("value")
    if name is not None:
        value = [str(one).format(tmp_path) for one in value] if isinstance(value, list) else value
        value = value.format(tmp_path) if isinstance(value, str) else value
        read = getattr(found, name)
        assert (str(read) if isinstance(read, Path) else read) == value
    (warned,) = capsys.readouterr().err.splitlines()
    assert line.split(" =")[0] in warned


@pytest.mark.parametrize(("line", "way"), [('sam = "sam"', "sam=NAME"), ("store = true", "--activities")])
def test_an_old_option_that_is_gone_says_what_to_do(line: str, way: str, tmp_path: Path):
    (tmp_path / "run.toml").write_text(f"{line}\n")
    with pytest.raises(InputError, match=f"--{line.split()[0]} is gone") as raised:
        options("generate", "--config", str(tmp_path / "run.toml"))
    assert way in str(raised.value)


@pytest.mark.parametrize(
    ("command", "line", "name", "value"),
    [
        ("compress", "lossless = true", "quality", math.inf),
        ("compress", 'effort = "full"', "preset", "full"),
        ("compress", 'effort = "fast"', "preset", "fast"),
        ("plot", "moving = true", "remove_static", "mean_chirp"),
        ("recognise", "quick = true", "sequences", 8),
        ("studio", 'recording = ["walk"]', "paths", ["{0}/walk"]),
        ("train", 'precision = "auto"', None, None),
        ("train", 'start = "base.safetensors"', "start", "base.safetensors"),
        ("export", "list = true", None, None),
        ("dataset", "each = 4", "per_class", 4),
    ],
)
def test_old_options_of_other_commands(command: str, line: str, name: str | None, value: Any, tmp_path: Path):
    (tmp_path / "run.toml").write_text(f"{line}\n")
    needed = {"compress": ["a", "--out", "b"], "plot": ["a", "--out", "b"], "recognise": ["train", "t.toml"]}
    needed |= {"train": ["weaver", "--out", "b"], "export": ["a", "--to", "npz", "--out", "b"]}
    needed |= {"dataset": ["set", "--activities", "a.toml"]}
    found = options(command, *needed.get(command, []), "--config", str(tmp_path / "run.toml"))
    if name is not None:
        read = getattr(found, name)
        assert (list(map(str, read)) if isinstance(read, list) else read) == (
            [one.format(tmp_path) for one in value] if isinstance(value, list) else value
        )


@pytest.mark.parametrize("method", ["weaver"])
def test_paths_that_a_file_leaves_out_are_left_out(method: str, tmp_path: Path):
    file = tmp_path / "run.toml"
    file.write_text(
        f'demo = true\ntext = ["a person stands"]\nframes = 2\nmethod = "{method}"\nno-pictures = true\n'
        'board = "ideal"\nbounces = 1\nclutter = "resolved"\n'
    )
    assert main(["generate", "--config", str(file), "--quiet", "--out", str(tmp_path / "out")]) == 0
    weaver = Weaver(KINDS[method](propagation=Propagation(bounces=1, clutter=False)))
    same = weaver.generate(weaver.sample_room(), "a person stands", frames=2, board="ideal")
    np.testing.assert_array_equal(read_radar_npz(tmp_path / "out" / "radar.npz").values, same.cube.values)
    again = options("generate", "--config", str(tmp_path / "out" / "request.toml"))
    assert again.method_set == ["bounces=1", "clutter=resolved"]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("frames = ", "no TOML"),
        ("frame = 3", "did you mean 'frames'?"),
        ("frames = true", "cannot be True"),
        ("bin = 1", "true or false"),
        ('frames = "many"', "no whole number"),
        ('command = "process"', "is of mmweaver process"),
        (None, "cannot read"),
    ],
)
def test_a_bad_file_is_one_line(content: str | None, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = tmp_path / "run.toml"
    if content is not None:
        file.write_text(content)
    assert main(["generate", "--demo", "--config", str(file), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert says in error
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()
