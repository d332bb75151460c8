"""Weight files: safetensors with a description in the header. No pickle.

The header contains format, recipe, version, licence, data set and radar, as recorded in `WeightsCard`, and the
sha256 of the tensors.
"""

import json
from dataclasses import MISSING, asdict, dataclass, field, fields
from importlib import resources
from pathlib import Path
from typing import Any

import torch
from torch import nn

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_tensors import read_tensor_metadata
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.models.environment_encoder import DEFAULT_ENCODER
from mmweaver.models.scatterer_network import WeaverNetwork

FORMAT = "mmweaver weights"
FORMAT_VERSION = 1
SIGNAL, POWER = "signal", "power"  # targets of recipe `hypernetwork`
EARLIER_RECIPES = {"paper": SIGNAL, "paper_power": POWER}  # which had a recipe each
SHIPPED = "weaver.safetensors"
WEIGHTS_FILE = "weights.safetensors"  # in a folder of mmweaver train, and in a repository on the Hub


@dataclass(frozen=True, kw_only=True)
class WeightsCard:
    """Description of a weight file, stored in its header."""

    recipe: str
    licence: str
    dataset_sha256: str  # of the data set's plan, or of the captures' cubes
    radar: str
    steps: int
    seed: int
    validation_loss: float
    mmweaver_version: str
    settings: dict[str, Any] = field(default_factory=dict)  # of the recipe
    tuned_from: str = ""  # sha256 of the tensors that fine-tuning started from

    @property
    def target(self) -> str | None:
        """Target of a hypernetwork, signal or power; None for other networks."""
        target = self.settings.get("target") if self.recipe == "hypernetwork" else EARLIER_RECIPES.get(self.recipe)
        return target if target in (SIGNAL, POWER) else None


def save_weights(file: Path, network: nn.Module, card: WeightsCard, *, half: bool = True) -> None:
    """Writes a network atomically.

    Args:
        file: The weight file.
        network: The network.
        card: Its description.
        half: Whether floats are stored in half precision, which halves the size without loss of quality.
    """
    dtype = torch.float16 if half else torch.float32
    tensors = {
        name: (tensor.to(dtype) if tensor.is_floating_point() else tensor).contiguous()
        for name, tensor in network.state_dict().items()
    }
    header = {
        "format": FORMAT,
        "format_version": str(FORMAT_VERSION),
        "card": json.dumps(asdict(card)),
    }
    write_tensors(file, tensors, header)


def load_weights(file: Path) -> tuple[WeaverNetwork, WeightsCard]:
    """Loads a weaver network, ready for use.

    Args:
        file: The weight file.

    Returns:
        The network and its card.

    Raises:
        InputError: For files that are damaged, foreign or of another version.
    """
    card, tensors = _read(file)
    if card.target is not None:
        raise InputError(f"{file} holds weights of recipe {card.recipe!r}; give those of: mmweaver train weaver")
    network = WeaverNetwork(encoder=card.settings.get("encoder", DEFAULT_ENCODER))
    _fill(network, file, tensors)
    return network, card


def load_into(network: nn.Module, file: Path, *, recipe: str | None = None, made_by: str | None = None) -> WeightsCard:
    """Loads weights into any network and makes it ready for use.

    Args:
        network: The network.
        file: The weight file.
        recipe: Required recipe; by default any.
        made_by: Command that makes such weights, for the error message.

    Returns:
        The card of the file.

    Raises:
        InputError: For files that do not fit the network, and for those of another recipe.
    """
    card, tensors = _read(file)
    command = f"mmweaver train {recipe}"
    if recipe is not None and card.recipe != recipe:
        raise InputError(f"{file} holds weights of recipe {card.recipe!r}; give those of: {made_by or command}")
    _fill(network, file, tensors)
    return card


def _fill(network: nn.Module, file: Path, tensors: dict[str, torch.Tensor]) -> None:
    """Loads tensors into a network and makes it ready for use; InputError if they do not fit."""
    wanted = network.state_dict()
    wrong = [name for name in wanted if name not in tensors or tensors[name].shape != wanted[name].shape]
    wrong += [name for name in tensors if name not in wanted]
    if wrong:
        raise InputError(
            f"{file} does not fit this version's network ({len(wrong)} tensors differ, {wrong[0]!r} first); train anew"
            " or take the mmweaver version that made it"
        )
    network.load_state_dict({name: tensor.to(wanted[name].dtype) for name, tensor in tensors.items()})
    network.eval()


def read_card(file: Path) -> WeightsCard:
    """Description of a weight file.

    Raises:
        InputError: As `load_weights`.
    """
    return _read(file)[0]


def shipped_weights() -> Path:
    """Path of the weights that come with mmweaver.

    Raises:
        InputError: If they are missing.
    """
    file = Path(str(resources.files("mmweaver") / "weights" / SHIPPED))
    if not file.is_file():
        raise InputError("this installation has no weights; train some with: mmweaver train, then give --weights FILE")
    return file


def _read(file: Path) -> tuple[WeightsCard, dict[str, torch.Tensor]]:
    check_exists(file, "a .safetensors file that mmweaver train wrote")
    header = read_tensor_metadata(file)
    if header.get("format") != FORMAT:
        raise InputError(f"{file} is not a weight file of mmweaver; give one that mmweaver train wrote")
    if header.get("format_version") != str(FORMAT_VERSION):
        raise InputError(
            f"{file} has weights of format {header.get('format_version')}, this mmweaver reads {FORMAT_VERSION}"
        )
    tensors, _ = read_tensors(file)
    return _card(header.get("card", ""), file), tensors


def _card(text: str, file: Path) -> WeightsCard:
    values: Any = parse_json(text, f"the card of {file}")
    try:
        wanted = [own.name for own in fields(WeightsCard) if own.default is own.default_factory is MISSING]
        known = [own.name for own in fields(WeightsCard) if own.name in values or own.name in wanted]
        card = WeightsCard(**{name: values[name] for name in known})
    except (KeyError, TypeError) as error:
        raise InputError(f"{file} has a header that cannot be read ({error}); fetch or write it again") from None
    if not isinstance(card.recipe, str) or not isinstance(card.settings, dict):
        raise InputError(f"{file} has a header that cannot be read; fetch or write it again")
    return card
