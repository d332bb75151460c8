"""Weights by file, by folder and by Hub name, and on the Hub, of which a folder takes the place."""

import shutil
from pathlib import Path
from typing import Any

import pytest
import torch
from torch import nn

from mmweaver.core.errors import InputError
from mmweaver.models.hub import find_weights, push_to_hub
from mmweaver.models.weights import WeightsCard, load_weights, save_weights, shipped_weights


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
    with pytest.raises(InputError, match="from the Hub") as caught:
        find_weights("nobody/nothing")
    assert "\n" not in str(caught.value)


PAGE = "---\nlicense: {licence}\nlibrary_name: mmweaver\n---\n\n# A network\n"
CARD = WeightsCard(recipe="pose", licence="CC-BY-4.0", dataset_sha256="", radar="awr1843", steps=1, seed=0,
                   validation_loss=1.0, mmweaver_version="0")  # fmt: skip


class Hub:
    """In place of huggingface_hub.HfApi: keeps what it is given in a folder."""

    folder: Path
    asked: list[dict[str, Any]]

    def __init__(self, library_name: str):
        assert library_name == "mmweaver"

    def create_repo(self, repo_id: str, *, private: bool, exist_ok: bool) -> None:
        if repo_id.startswith("other/"):
            raise PermissionError("403 Forbidden:\nyou are not other")
        assert exist_ok
        self.asked.append({"repo_id": repo_id, "private": private})

    def upload_folder(self, *, repo_id: str, folder_path: str, revision: str | None) -> str:
        shutil.copytree(folder_path, self.folder / repo_id)
        self.asked[-1]["revision"] = revision
        return f"https://huggingface.co/{repo_id}/commit/0"


@pytest.fixture
def hub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> type[Hub]:
    huggingface_hub = pytest.importorskip("huggingface_hub")
    own = type("OwnHub", (Hub,), {"folder": tmp_path / "hub", "asked": []})
    monkeypatch.setattr(huggingface_hub, "HfApi", own)
    return own


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A folder as mmweaver train leaves it, with two networks."""
    folder = tmp_path / "run"
    (folder / "pictures").mkdir(parents=True)
    for name in ("weights.safetensors", "weights_2.safetensors", "best.safetensors"):
        save_weights(folder / name, nn.Linear(3, 2), CARD)
    (folder / "README.md").write_text(PAGE.format(licence="cc-by-4.0"))
    for name in ("checkpoint.pt", "request.toml", "log.jsonl", "pictures/1.png"):
        (folder / name).write_text("private")
    return folder


def test_a_file_is_found_there_as_it_was(hub: type[Hub]):
    address = push_to_hub(shipped_weights(), "me/room", private=True)
    assert address == "https://huggingface.co/me/room/commit/0"
    assert hub.asked == [{"repo_id": "me/room", "private": True, "revision": None}]
    there = hub.folder / "me" / "room"
    assert {file.name for file in there.iterdir()} == {"weights.safetensors", "README.md"}
    network, card = load_weights(there / "weights.safetensors")
    own, own_card = load_weights(shipped_weights())
    assert card == own_card
    assert all(torch.equal(own.state_dict()[name], tensor) for name, tensor in network.state_dict().items())


def test_of_a_run_only_weights_and_their_card_leave_the_machine(hub: type[Hub], run: Path):
    push_to_hub(run, "me/poses", revision="try")
    there = hub.folder / "me" / "poses"
    assert {file.name for file in there.rglob("*")} == {"weights.safetensors", "weights_2.safetensors", "README.md"}
    assert hub.asked[-1]["revision"] == "try"
    assert (there / "weights_2.safetensors").read_bytes() == (run / "weights_2.safetensors").read_bytes()


def test_what_the_hub_refuses_is_one_line(hub: type[Hub], run: Path):
    with pytest.raises(InputError, match="403 Forbidden"):
        push_to_hub(run, "other/poses")
