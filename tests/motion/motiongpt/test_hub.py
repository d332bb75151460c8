"""Names on the Hub, and what is said where it cannot be reached."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.motiongpt.hub import PUBLISHED, looks_like_hub, published_checkpoint


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
    with pytest.raises(InputError, match=r"motiongpt_s3_h3d\.tar of .* download it yourself") as caught:
        published_checkpoint(PUBLISHED)
    assert "\n" not in str(caught.value)
