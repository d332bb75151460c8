"""Checkpoints: sizes are inferred from the tensors; damaged or foreign files are refused by name."""

import zipfile
from pathlib import Path

import pytest
import torch
from motiongpt_files import TINY, TINY_T5, published, tiny

from mmweaver.core.errors import InputError
from mmweaver.motion.motiongpt.checkpoint import (
    check_state,
    parts_of,
    read_checkpoint,
    t5_sizes,
    tokenizer_config,
)
from tests.motion.motiongpt_weights import state_of


class Anything:
    """What a stranger's pickle may hold."""


def test_the_published_format_is_read_and_its_sizes_are_found(tmp_path: Path):
    path = published(tmp_path)
    state, notes = read_checkpoint(path)
    assert notes == {}
    vae, spoken = parts_of(state, path)
    assert tokenizer_config(vae, path) == TINY
    sizes = t5_sizes(spoken, path)
    assert {name: sizes[name] for name in TINY_T5} == TINY_T5
    assert not any(name.startswith(("metrics", "_losses")) for name in (*vae, *spoken))


def test_pickles_of_something_else_are_not_opened(tmp_path: Path):
    torch.save({"state_dict": {}, "hyper_parameters": Anything()}, tmp_path / "other.tar")
    with pytest.raises(InputError, match="pickled"):
        read_checkpoint(tmp_path / "other.tar")
    torch.save([1, 2, 3], tmp_path / "list.pt")
    torch.save({"state_dict": {"epoch": 3}}, tmp_path / "epoch.pt")
    for name in ("list.pt", "epoch.pt"):
        with pytest.raises(InputError, match="no state_dict"):
            read_checkpoint(tmp_path / name)


def test_files_that_are_cut_short_or_no_checkpoints(tmp_path: Path):
    whole = published(tmp_path / "whole")
    (tmp_path / "half.tar").write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    (tmp_path / "text.ckpt").write_text("weights")
    (tmp_path / "text.safetensors").write_text("weights")
    (tmp_path / "empty.pt").write_bytes(b"")
    with zipfile.ZipFile(tmp_path / "zip.pt", "w") as archive:
        archive.writestr("readme.txt", "hello")
    for name in ("half.tar", "text.ckpt", "text.safetensors", "empty.pt", "zip.pt"):
        with pytest.raises(InputError) as caught:
            read_checkpoint(tmp_path / name)
        assert "\n" not in str(caught.value)
        assert name in str(caught.value)
    with pytest.raises(InputError, match="no checkpoint"):
        read_checkpoint(tmp_path / "none.tar")


def test_missing_and_misshapen_tensors_are_named(tmp_path: Path):
    tokenizer, language, *_ = tiny()
    state = state_of(tokenizer, language)
    vae, spoken = parts_of(state, tmp_path)
    with pytest.raises(InputError, match=r"no vae\.\*, but lm\.language_model\.shared"):
        parts_of({name: value for name, value in state.items() if name.startswith("lm.")}, tmp_path)
    with pytest.raises(InputError, match=r"lacks vae\.quantizer\.codebook"):
        tokenizer_config({name: value for name, value in vae.items() if "codebook" not in name}, tmp_path)
    with pytest.raises(InputError, match=r"lacks lm\.language_model\.shared\.weight"):
        t5_sizes({name: value for name, value in spoken.items() if "shared" not in name}, tmp_path)
    few = {name: value for name, value in vae.items() if not name.startswith("decoder")}
    with pytest.raises(InputError, match=r"lacks vae\.decoder\.model\.0\.weight, .* and \d+ more"):
        check_state(few, tokenizer.state_dict(), "vae.", tmp_path)
    other = vae | {"decoder.model.4.weight": torch.zeros(4, 4, 3)}
    with pytest.raises(InputError, match=r"vae\.decoder\.model\.4\.weight is \(4, 4, 3\) and not \(16, 16, 3\)"):
        check_state(other, tokenizer.state_dict(), "vae.", tmp_path)
