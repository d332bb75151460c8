"""Weight files: there and back, and what is refused."""

import pickle

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import WeightsCard, load_into, load_weights, read_card, save_weights

CARD = WeightsCard(
    recipe="weaver", licence="MIT", dataset_sha256="0" * 64, radar="awr1843", steps=1, seed=0, validation_loss=1.0,
    mmweaver_version="0",
)  # fmt: skip


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory):
    file = tmp_path_factory.mktemp("weights") / "weights.safetensors"
    torch.manual_seed(1)
    save_weights(file, WeaverNetwork(), CARD)
    return file


def test_there_and_back(file):
    torch.manual_seed(1)
    made, (read, card) = WeaverNetwork(), load_weights(file)
    assert card == CARD
    for name, tensor in made.state_dict().items():
        assert torch.allclose(tensor, read.state_dict()[name], atol=2e-3, rtol=2e-3), name


def test_damaged_foreign_and_pickled_files_are_refused_in_one_line(file, tmp_path):
    from safetensors.torch import save_file

    short = tmp_path / "short.safetensors"
    short.write_bytes(file.read_bytes()[:100_000])
    foreign = tmp_path / "foreign.safetensors"
    save_file({"a": torch.zeros(3)}, foreign)
    pickled = tmp_path / "pickled.pt"
    pickled.write_bytes(pickle.dumps({"a": 1}))
    old = tmp_path / "old.safetensors"
    save_file({"a": torch.zeros(3)}, old, metadata={"format": "mmweaver weights", "format_version": "0", "card": "{}"})
    for wrong, told in (
        (short, "damaged"), (foreign, "not a weight file"), (pickled, "pickled"), (old, "format 0"),
        (tmp_path / "none", "does not exist"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=told) as caught:
            load_weights(wrong)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "other", [torch.nn.Linear(3, 2), torch.nn.Sequential(WeaverNetwork(), torch.nn.Linear(3, 2))], ids=["less", "more"]
)
def test_weights_of_another_network_are_refused_in_one_line(other, file):
    with pytest.raises(InputError, match="does not fit") as refused:
        load_into(other, file)
    assert "\n" not in str(refused.value)


def test_values_that_changed_are_found(file, tmp_path):
    """A flipped bit fits the network as well as the right one; only the sum tells."""
    flipped = bytearray(file.read_bytes())
    flipped[-1000] ^= 1
    wrong = tmp_path / "flipped.safetensors"
    wrong.write_bytes(flipped)
    with pytest.raises(InputError, match="written"):
        load_weights(wrong)


def test_cards_of_before_are_read(file, tmp_path):
    """Fields that came later have defaults; others must be there."""
    import json

    from safetensors.torch import save_file

    own = {"recipe": "weaver", "licence": "MIT", "dataset_sha256": "", "radar": "awr1843", "steps": 1, "seed": 0,
           "validation_loss": 1.0, "mmweaver_version": "0"}  # fmt: skip
    for card, is_read in ((own, True), ({"recipe": "weaver"}, False)):
        header = {"format": "mmweaver weights", "format_version": "1", "card": json.dumps(card)}
        save_file({"a": torch.zeros(3)}, tmp_path / "old.safetensors", metadata=header)
        if is_read:
            assert read_card(tmp_path / "old.safetensors").tuned_from == ""
        else:
            with pytest.raises(InputError, match="header"):
                read_card(tmp_path / "old.safetensors")


def test_others_may_read_the_file(file):
    assert file.stat().st_mode & 0o400
    assert file.stat().st_mode & 0o777 == 0o666 & ~_umask()


def _umask() -> int:
    import os

    mask = os.umask(0)
    os.umask(mask)
    return mask
