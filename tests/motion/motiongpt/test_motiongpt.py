"""The whole model: a checkpoint in the published format generates; the std trap, lengths and folders."""

from pathlib import Path

import numpy as np
import pytest
from motiongpt_files import published, tiny

from mmweaver.core.errors import InputError
from mmweaver.motion.motiongpt.motiongpt import MotionGPT, check_std
from tests.motion.motiongpt_weights import save_published, save_weights


def test_a_published_checkpoint_loads_and_generates(tmp_path: Path):
    """Loaded from its folder, from its file, and saved anew in the published format: all the same motion."""
    path = published(tmp_path / "model")
    from_folder, from_file = MotionGPT.load(path.parent), MotionGPT.load(path)
    clip = from_folder.generate("a person walks", seconds=2.5, seed=1)
    assert clip.joints_m.shape == (50, 22, 3)
    assert clip.fps == 20.0
    assert np.isfinite(clip.joints_m).all()
    np.testing.assert_array_equal(from_file.generate("a person walks", seconds=2.5, seed=1).joints_m, clip.joints_m)
    assert not np.allclose(from_file.generate("a person walks", seconds=2.5, seed=2).joints_m, clip.joints_m)
    save_published(path, from_file.tokenizer, from_file.language)
    again = MotionGPT.load(path).generate("a person walks", seconds=2.5, seed=1)
    np.testing.assert_array_equal(again.joints_m, clip.joints_m)


def test_one_file_of_our_own_holds_everything(tmp_path: Path):
    tokenizer, language, plain, mean, std = tiny()
    file = tmp_path / "small.safetensors"
    save_weights(file, tokenizer=tokenizer, language=language, mean=mean, std=std, vocabulary=plain)
    clip = MotionGPT.load(file).generate("a person walks", seconds=2.5, seed=1)
    other = MotionGPT.load(published(tmp_path / "model")).generate("a person walks", seconds=2.5, seed=1)
    np.testing.assert_allclose(clip.joints_m, other.joints_m, atol=1e-5)
    save_weights(file, tokenizer=tokenizer, language=language, mean=mean, std=std, vocabulary=plain, half=True)
    assert MotionGPT.load(file).generate("a person walks", seconds=2.5).joints_m.shape == (50, 22, 3)
    odd = MotionGPT.load(file).generate("a person moonwalks", seconds=2.0)
    assert "moonwalks" in odd.notes[-1]


def test_lengths(tmp_path: Path):
    model = MotionGPT.load(published(tmp_path))
    assert model.generate("a person walks", seconds=0.33).joints_m.shape[0] == 7
    assert model.generate("a person walks", seconds=9.8).joints_m.shape[0] == 196
    with pytest.raises(InputError, match=r"up to 9\.8 s"):
        model.generate("a person walks", seconds=9.9)
    with pytest.raises(InputError, match="empty"):
        model.generate("  ", seconds=2.0)
    with pytest.raises(InputError, match="tokens"):
        model.generate("walks " * 300, seconds=2.0)


def test_the_std_of_another_data_set_is_refused(tmp_path: Path):
    """HumanML3D's own Std.npy beside MotionGPT's checkpoint: motion that looks broken, and nobody says why."""
    path = published(tmp_path)
    std = np.load(tmp_path / "std.npy")
    std[259:263] = 0.45
    np.save(tmp_path / "std.npy", std)
    with pytest.raises(InputError, match="HumanML3D's own"):
        MotionGPT.load(path)
    check_std(std / 25, path)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda folder: (folder / "std.npy").unlink(), r"std\.npy is missing"),
        (lambda folder: np.save(folder / "mean.npy", np.zeros(251)), r"shape \(251,\)"),
        (lambda folder: np.save(folder / "mean.npy", np.array([{}], object), allow_pickle=True), "pickled objects"),
        (lambda folder: (folder / "tokenizer.json").write_text("{}"), "text tokenizer"),
        (lambda folder: (folder / "second.ckpt").write_text(""), "2 checkpoints"),
        (lambda folder: (folder / "motiongpt_s3_h3d.tar").unlink(), "no checkpoint"),
    ],
)
def test_what_is_missing_beside_it_is_said(tmp_path: Path, damage, message: str):
    published(tmp_path)
    damage(tmp_path)
    with pytest.raises(InputError, match=message) as caught:
        MotionGPT.load(tmp_path)
    assert "\n" not in str(caught.value)
