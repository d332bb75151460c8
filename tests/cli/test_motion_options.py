"""mmweaver generate --motion and --motion-model: a recorded walk in a room, and every contradiction in one line."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.io.npz_files import read_npz

FPS = 30.0


def waving(seconds: float = 1.0) -> np.ndarray:
    """A person of 1.7 m who stands and moves an arm, y up, in centimetres."""
    from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward

    time_s = np.arange(round(seconds * FPS)) / FPS
    rotations = np.zeros((len(time_s), NUM_JOINTS, 3))
    rotations[:, 16, 2], rotations[:, 17, 2] = -1.2, 1.2
    rotations[:, 18, 1] = -0.8 + 0.6 * np.sin(2 * np.pi * time_s)
    return 100 * forward(rotations, np.tile([3.0, 1.4, 8.0], (len(time_s), 1)), MEAN_OFFSET_M)


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    np.save(tmp_path / "arm.npy", waving())
    return tmp_path / "arm.npy"


def test_a_recorded_motion_in_the_sample_room(recorded: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    out = tmp_path / "out"
    argv = [
        *["generate", "--demo", "--motion"],
        str(recorded),
        *["--motion-set", "fps=30", "--frames", "5", "--out"],
        str(out),
    ]
    argv += ["--at", "0.1,1.7", "--heading", "-20", "--height", "1.85", "--no-pictures"]
    assert main(argv) == 0
    shown = capsys.readouterr().out
    assert "arm.npy are taken as cm" in shown
    assert "scaled to 1.85 m" in shown
    meta = json.loads((out / "meta.json").read_text())
    assert meta["text"] == "arm.npy"
    assert len(meta["inputs"]["motion"]["sha256"]) == 64
    assert meta["inputs"]["motion"]["fps"] == 30.0
    assert meta["placed"]["height_m"] == 1.85
    pose = read_npz(out / "pose.npz")
    np.testing.assert_allclose(pose["joints_m"][0, 0, :2], [0.1, 1.7], atol=0.01)
    across = pose["joints_m"][0, 1] - pose["joints_m"][0, 2]  # left hip from right hip
    facing = np.degrees(np.arctan2(-across[0], across[1]))
    assert facing == pytest.approx(-110, abs=3)  # hips of the mean body are a little askew
    assert main([*argv, "--overwrite", "--quiet"]) == 0
    np.testing.assert_array_equal(read_npz(out / "pose.npz")["joints_m"], pose["joints_m"])


def test_as_recorded(tmp_path: Path):
    """What mmweaver itself wrote goes back in at its own place."""
    first, again = tmp_path / "first", tmp_path / "again"
    text = ["--text", "a person waves", "--frames", "6", "--quiet", "--no-pictures"]
    assert main(["generate", "--demo", *text, "--out", str(first)]) == 0
    argv = ["generate", "--demo", "--motion", str(first / "pose.npz"), "--as-recorded", "--frames", "6", "--quiet"]
    assert main([*argv, "--no-pictures", "--out", str(again)]) == 0
    one, other = (read_npz(folder / "pose.npz")["joints_m"] for folder in (first, again))
    np.testing.assert_allclose(other, one, atol=5e-3)  # and the sway of whoever moves so


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--motion", "arm.npy"], "--motion-set fps="),
        (["--motion", "none.bvh"], "there is no motion file"),
        (["--motion", "arm.npy", "--motion-set", "fps=30", "--frames", "20"], r"lasts 1 s, 2 s are asked for"),
        (["--motion", "arm.npy", "--motion-set", "fps=30", "--motion-set", "start=4"], "cannot start at 4 s"),
        (["--motion", "arm.npy", "--motion-set", "fps=30", "--frames", "5", "--at", "0.1,9"], "nearest free place"),
        (["--motion", "arm.npy", "--motion-set", "fps=30", "--motion-set", "unit=ell"], "no unit of length"),
        (["--motion", "arm.npy", "--motion-set", "fps=30", "--frames", "5", "--height", "9"], "body height"),
        (["--motion", "arm.npy", "--as-recorded", "--at", "0,2"], "moves nothing"),
        (["--text", "a person walks", "--motion-set", "unit=cm"], "--motion-set is about a recorded motion"),
        (["--text", "a person walks", "--as-recorded"], "--as-recorded is about a recorded motion"),
        (["--text", "a person waves", "--path", "0,2 0,1.5"], "walks or runs"),
        (["--motion", "arm.npy", "--motion-model", "m.tar"], "give one of them"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(
    words: list[str], message: str, recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["generate", "--demo", *words, "--out", "out"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert message in error
    assert not (tmp_path / "out").exists()
