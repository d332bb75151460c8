"""What others add works like what is built in: the page that says how is run, plug-ins are found, broken ones named."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.registry import Registry
from mmweaver.weaver import register

ROOT = Path(__file__).resolve().parents[1]
MODULE = """
import numpy as np
from dataclasses import replace
from mmweaver import PRESETS, RadarCube, register
from mmweaver.core.records import CubeGrid
from mmweaver.models.methods import Signal

near = replace(PRESETS["awr1843"], name="near", first_range_bin=8)

def make():
    def ones(scene, poses, config, *, num_frames, seed, keep_adc, stages, **more):
        grid = CubeGrid.of(config, num_frames)
        cube = RadarCube(values=np.ones(grid.shape, np.complex64), grid=grid, config=config, scale=1.0)
        return Signal(cube=cube, adc=None, assumptions=())
    return ones

def activities():
    register.activity("flail", name="flailing", example="a person flails", verbs=("flail",), hands=True,
                      perform=lambda context, controls: controls, least_s=0.5, natural_s=1.0)
"""
ENTRY_POINTS = """
[mmweaver.models.methods]
ones = plugged:make
broken = plugged_but_missing:make
[mmweaver.radars]
near = plugged:near
[mmweaver.activities]
flail = plugged:activities
"""


@pytest.fixture
def plugged(tmp_path: Path) -> dict[str, str]:
    """The environment of a machine where a package with entry points is installed."""
    info = tmp_path / "plugged-1.0.dist-info"
    info.mkdir()
    (tmp_path / "plugged.py").write_text(MODULE)
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: plugged\nVersion: 1.0\n")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT / "src"), str(ROOT)])}


def mmweaver(env: dict[str, str], *commands: list[str]) -> subprocess.CompletedProcess[str]:
    """One start for several commands; the exit status is the last one's."""
    code = f"from mmweaver.cli.main import main; import sys; sys.exit([main(argv) for argv in {commands}][-1])"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=env)


def test_plug_ins_on_the_command_line(plugged: dict[str, str], tmp_path: Path):
    out = str(tmp_path / "out")
    argv = ["generate", "--demo", "--frames", "3", "--no-pictures", "--radar", "near", "--out", out]
    done = mmweaver(plugged, [*argv, "--method", "ones", "--text", "a person flails"])
    assert done.returncode == 0, done.stderr
    assert "method:  ones" in done.stdout
    assert "flailing" in done.stdout


def test_a_broken_plug_in_is_one_line_and_hurts_nobody_else(plugged: dict[str, str], tmp_path: Path):
    argv = ["generate", "--demo", "--out", str(tmp_path / "out"), "--method"]
    done = mmweaver(plugged, [*argv, "broken"], [*argv, "nope"])
    assert done.returncode == 2
    broken, unknown = done.stderr.splitlines()
    for word in ("plugged 1.0", "plugged_but_missing", "update or uninstall"):
        assert word in broken
    assert "known: auto, weaver, physics, ones, broken" in unknown


def test_a_name_is_given_once():
    registry: Registry[str] = Registry("thing", [("one", "1")])
    registry.register("two", "2")
    registry.register("two", "2")
    assert list(registry) == ["one", "two"]
    with pytest.raises(InputError, match="'two'"):
        registry.register("two", "3")
    with pytest.raises(InputError, match="known: one, two"):
        registry["three"]
    register.radar(AWR1843)  # the same again is no error
    with pytest.raises(InputError, match="already"):
        register.method("physics", dict)
    for key, verb, says in (("wave", "undulate", "activity 'wave' already"), ("undulate", "wave", "another activity")):
        with pytest.raises(InputError, match=says):
            register.activity(
                key, name="undulating", example="a person undulates", verbs=(verb,), perform=dict, least_s=1.0,
                natural_s=2.0,
            )  # fmt: skip
