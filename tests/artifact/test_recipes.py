"""What the README tells a reader to type runs in an empty folder, by the wheel that was built and installed.

In `make test` all of it runs in one process, smaller where smaller.py says so; by night a shell runs every line as it
stands (test_sdist.py).
"""

import re
from pathlib import Path

import numpy as np
from PIL import Image

from mmweaver.cli.main import COMMANDS
from mmweaver.io.npz_files import read_radar_npz
from tests.artifact.artifact import Installed


def test_every_line_of_the_readme_runs(carried_out: tuple[Path, dict[str, str]]):
    place, printed = carried_out
    lines = [line for line in printed if not line.endswith(" --help")]
    outputs = [word for line in lines for word in re.findall(r"--out (\S+)|dataset (\S+)|sample (\S+)", line)]
    names = ["".join(groups).rstrip("/") for groups in outputs]
    assert len(names) >= 9
    for name in names:
        (found,) = {path for path in (place / name, place / "room" / name) if path.exists()}
        assert found.is_file() or any(found.iterdir())


def test_the_demo_is_drawn(carried_out: tuple[Path, dict[str, str]]):
    place, _ = carried_out
    with Image.open(place / "demo" / "preview.png") as picture:
        assert min(picture.size) > 500
        assert np.asarray(picture.convert("L")).std() > 20
    with Image.open(place / "demo" / "preview.gif") as moving:
        assert getattr(moving, "n_frames", 1) > 10


def test_the_cube_of_the_python_has_the_axes_that_the_readme_names(carried_out: tuple[Path, dict[str, str]]):
    """By default 64 ranges, 32 velocities, 12 antennas."""
    assert read_radar_npz(carried_out[0] / "room" / "walk" / "radar.npz").values.shape[1:] == (64, 32, 12)


def test_the_command_runs_as_pip_installs_it(installed: Installed, tmp_path: Path):
    done = installed.run([installed.script, "motion", "a person walks"], tmp_path, extras=[])
    assert done.returncode == 0, done.stderr
    assert "walking" in done.stdout
    assert not any(tmp_path.iterdir())


def test_every_command_has_a_help(carried_out: tuple[Path, dict[str, str]]):
    for name in COMMANDS:
        assert carried_out[1][f"mmweaver {name} --help"].startswith(f"usage: mmweaver {name} ")
