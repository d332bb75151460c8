"""Names on the Hub, and what is said where it cannot be reached."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.motiongpt.checkpoint import PUBLISHED, published_checkpoint


def test_without_a_connection_one_line_says_what_to_do(monkeypatch: pytest.MonkeyPatch):
    import huggingface_hub

    def offline(**_: object) -> str:
        raise OSError("no route\nto host")

    monkeypatch.setattr(huggingface_hub, "hf_hub_download", offline)
    with pytest.raises(InputError, match=r"motiongpt_s3_h3d\.tar") as caught:
        published_checkpoint(PUBLISHED)
    assert "\n" not in str(caught.value)
