"""Names on the Hub, and what is said where it cannot be reached."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.motiongpt.checkpoint import PUBLISHED, SMALL, looks_like_hub, published_checkpoint


def test_names_and_paths_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    assert looks_like_hub(PUBLISHED)
    assert not looks_like_hub("motiongpt.tar")
    assert not looks_like_hub("weights/motiongpt.tar")
    (tmp_path / "weights").mkdir()
    assert not looks_like_hub("weights/motiongpt")


def test_without_a_connection_one_line_says_what_to_do(monkeypatch: pytest.MonkeyPatch):
    import huggingface_hub

    def offline(**_: object) -> str:
        raise OSError("no route\nto host")

    monkeypatch.setattr(huggingface_hub, "hf_hub_download", offline)
    with pytest.raises(InputError, match=r"motiongpt_s3_h3d\.tar") as caught:
        published_checkpoint(PUBLISHED)
    assert "\n" not in str(caught.value)


def test_a_repository_of_the_small_model_is_found_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    import huggingface_hub
    from huggingface_hub.errors import EntryNotFoundError

    asked = []

    def download(*, repo_id: str, filename: str) -> str:
        asked.append(filename)
        if filename != SMALL:
            raise EntryNotFoundError("no such file")
        return str(tmp_path / filename)

    monkeypatch.setattr(huggingface_hub, "hf_hub_download", download)
    assert published_checkpoint("owner/small-motiongpt") == tmp_path / SMALL
    assert len(asked) == 2
