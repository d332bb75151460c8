"""Weights by file, by folder and by Hub name."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.models.find_weights import find_weights


def test_a_file_and_a_folder(tmp_path: Path):
    file = tmp_path / "weights.safetensors"
    file.write_bytes(b"")
    assert find_weights(tmp_path) == find_weights(str(file)) == file
    (tmp_path / "empty").mkdir()
    for wrong, told in (
        (tmp_path / "empty", "holds no weights.safetensors"), (tmp_path / "none.safetensors", "does not exist"),
        ("run/none.safetensors", "does not exist"), ("no name", "does not exist"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=told):
            find_weights(wrong)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The Hub's cache of a machine without a network."""
    pytest.importorskip("huggingface_hub")
    from huggingface_hub import constants

    monkeypatch.setattr(constants, "HF_HUB_CACHE", str(tmp_path))
    monkeypatch.setattr(constants, "HF_HUB_OFFLINE", True)
    return tmp_path


def test_a_hub_name_is_taken_from_the_cache(cache: Path):
    commit = "0123456789abcdef0123456789abcdef01234567"
    own = cache / "models--somebody--weights"
    (own / "snapshots" / commit).mkdir(parents=True)
    (own / "refs").mkdir()
    (own / "refs" / "main").write_text(commit)
    (own / "snapshots" / commit / "weights.safetensors").write_bytes(b"kept")
    assert find_weights("somebody/weights").read_bytes() == b"kept"


def test_a_hub_name_that_cannot_be_had_is_one_line(cache: Path):
    with pytest.raises(InputError, match="cannot be had from the Hub") as caught:
        find_weights("nobody/nothing")
    assert "\n" not in str(caught.value)
