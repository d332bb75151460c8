"""Training of the learned method: recipe, learner, weights and model card."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.radar_config import RadarConfig
from mmweaver.datasets.dataset_store import plan_text, read_plan
from mmweaver.models.environment_encoder import DEFAULT_ENCODER
from mmweaver.models.precision import exactly
from mmweaver.models.scatterer_network import ScattererNetwork, WeaverNetwork
from mmweaver.propagation.mean_power import MeanEchoes, MeanPower, PowerMaps
from mmweaver.propagation.radar_equation import points_of
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.model_card import WEAVER, Figures
from mmweaver.training.network_examples import NetworkBatch, RoomExamples, examples, sample_batch
from mmweaver.training.network_loss import weaver_loss
from mmweaver.training.trained_weights import weights_card, write_trained
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import differences_db, draw_sheet

VALIDATION_SEED = 10_000  # added to the recipe's seed
EXPLAINED = "0 is perfect; even the exact mean is 4 to 5 dB from any single realization of the phases."


@dataclass(frozen=True, kw_only=True)
class TrainingRecipe(LoopRecipe):
    """Hyperparameters of the learned method."""

    name: str = "weaver"
    batch_size: int = 3  # sequences, each of a different room
    frames: int = 8  # sampled from each sequence
    mirror: bool = True  # reflect every second batch left-right
    corrects_surfaces: bool = False  # learn the cross section of photographed surfaces instead of using physics
    encoder: str = DEFAULT_ENCODER  # environment encoder, a key of ENCODERS


class NetworkLearner(Learner):
    """The network with the radar that converts its echoes to maps."""

    def __init__(
        self,
        network: ScattererNetwork,
        config: RadarConfig,
        shown: Callable[[], NetworkBatch] | None = None,
    ):
        """Combines network and radar.

        Args:
            network: The network.
            config: The radar.
            shown: Returns the sequences that are plotted. Default: none.
        """
        super().__init__()
        self.network = network
        self.radar = MeanPower(config)
        self.shown = shown

    def _apply(self, fn: Any, recurse: bool = True) -> "NetworkLearner":
        """Moves the tensors of the radar along with the network."""
        super()._apply(fn, recurse)
        self.radar.to(self.device)
        return self

    @property
    def device(self) -> torch.device:
        """Device of the network."""
        return next(self.network.parameters()).device

    def terms(self, batch: NetworkBatch) -> dict[str, torch.Tensor]:
        """Terms of `weaver_loss`."""
        code = self.network.encode_room(batch.scene)
        moving = self.moving(code, batch)
        with exactly(batch.joints_m):
            return weaver_loss(self.radar, code.static, moving, batch.targets)

    def moving(self, code: Any, batch: NetworkBatch) -> MeanEchoes:
        """Mean echoes of the people in a batch."""
        return self.network.moving(code, batch.joints_m, batch.velocity_mps, batch.frames)

    def predict(self, batch: NetworkBatch) -> PowerMaps:
        """Predicts power maps of room, person and noise.

        Args:
            batch: The batch.

        Returns:
            Mean power in mW, (sequence, frame, range, other).
        """
        code = self.network.encode_room(batch.scene)
        moving = self.moving(code, batch)
        with exactly(batch.joints_m):
            static = self.radar.maps(points_of(code.static, self.radar.response))
            person = self.radar.maps(points_of(moving, self.radar.response))
        names = ("range_doppler", "range_azimuth", "range_elevation")
        return PowerMaps(
            **{
                name: getattr(person, name) + getattr(static, name)[:, None] + noise
                for name, noise in zip(names, self.radar.noise_maps(), strict=True)
            }
        )

    def picture(self) -> np.ndarray | None:
        """Maps of ground truth and network on `shown`, or None."""
        if self.shown is None:
            return None
        batch = moved(self.shown(), self.device)
        return draw_sheet(batch.targets.maps, self.predict(batch), self.radar.config)


def train(
    data: Path,
    out: Path,
    recipe: TrainingRecipe,
    *,
    start: dict[str, torch.Tensor] | None = None,
    listener: Listener | None = None,
    compute: ComputeDevice | None = None,
    **options: Any,
) -> Trainer[NetworkLearner]:
    """Trains on split `train` of a data set of rooms, or resumes from `out`/checkpoint.pt.

    Args:
        data: Folder of the data set.
        out: Folder of the run.
        recipe: Hyperparameters.
        start: Weights to fine-tune. Default: random.
        listener: Called with the progress of each step. Default: none.
        compute: Device, precision and process. Default: CPU in float32.
        **options: Further arguments of `Trainer`.

    Returns:
        The trainer with the best network on split `validation`.

    Raises:
        InputError: If the folder contains no data, or training diverges.
    """
    options = {"is_tuning": start is not None} | options
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    validation = batch_sampler(unseen, recipe, VALIDATION_SEED + recipe.seed)
    learner = NetworkLearner(initial_network(recipe, start), rooms[0].room.config, shown=lambda: validation(0, (0, 1)))
    trainer = Trainer(
        learner,
        recipe,
        out,
        compute=compute,
        batches=(batch_sampler(rooms, recipe, recipe.seed, recipe.mirror), validation),
        **options,
    )
    trainer.run(listener)
    return trainer


def initial_network(recipe: LoopRecipe, start: dict[str, torch.Tensor] | None) -> WeaverNetwork:
    """Creates the network from which training starts.

    Args:
        recipe: Hyperparameters.
        start: Weights to load; None for random ones.

    Returns:
        The network.
    """
    assert isinstance(recipe, TrainingRecipe), "a recipe of this network"
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork(corrects_surfaces=recipe.corrects_surfaces, encoder=recipe.encoder)
    if start is not None:
        network.load_state_dict(start)
    return network


def batch_sampler(rooms: list[RoomExamples], recipe: TrainingRecipe, seed: int, mirror: bool = False) -> BatchSampler:
    """Creates a sampler of batches by step.

    Args:
        rooms: The rooms.
        recipe: Hyperparameters.
        seed: Seed of the batches.
        mirror: Whether batches are reflected at random. Default: False.

    Returns:
        Function of step and share.
    """
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: sample_batch(rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror)


def write_weights(
    out: Path, data: Path, trainer: Trainer[NetworkLearner], *, start: dict[str, torch.Tensor] | None = None
) -> Path:
    """Writes weights.safetensors and its model card README.md.

    Args:
        out: Folder of the run.
        data: Folder of the data set.
        trainer: The finished run.
        start: Initial weights, as a baseline. Default: random.

    Returns:
        Path of the weights.
    """
    plan = read_plan(data)
    about = (
        f"{len(plan['kinds'])} kinds of rooms, {plan['num_layouts']} layouts of each, {plan['sequences_a_room']}"
        f" sequences of {plan['num_frames']} frames in every room, radar {plan['radar']}, seed {plan['seed']}"
    )
    unseen = _counted(examples(data, "validation"))
    digest = hashlib.sha256(plan_text(data).encode()).hexdigest()
    return write_trained(
        out,
        trainer,
        weights_card(trainer, dataset_sha256=digest, radar=trainer.learner.radar.config.name),
        page=WEAVER,
        data=f"Generated by `mmweaver dataset` ({about}). Trained on {_counted(examples(data, 'train'))}.",
        evaluated_on=f"Mean difference in dB of power maps on {unseen} of kinds not trained on; {EXPLAINED}",
        figures=compare_with_start(trainer, initial_network(trainer.recipe, start)),
    )


def compare_with_start(trainer: Trainer[NetworkLearner], start: ScattererNetwork) -> Figures:
    """Evaluates network, initial weights and empty maps on the validation batches.

    Args:
        trainer: The finished run.
        start: Network with the initial weights.

    Returns:
        Mean map differences in dB by method.
    """
    learner = trainer.learner
    rows: dict[str, list[dict[str, float]]] = {}
    trained = learner.network
    with torch.inference_mode():
        for batch in trainer.validation_batches():
            truth, own = batch.targets.maps, learner.predict(batch)
            learner.network = start.to(learner.device).eval()
            before = learner.predict(batch)
            learner.network = trained
            nothing = PowerMaps(**{name: 0 * value for name, value in vars(truth).items()})
            for who, maps in (("this network", own), ("initial weights", before), ("empty maps", nothing)):
                rows.setdefault(who, []).append(differences_db(truth, maps))
    return {who: {name: float(np.mean([row[name] for row in each])) for name in each[0]} for who, each in rows.items()}


def _counted(rooms: list[RoomExamples]) -> str:
    return f"{sum(len(room.indices) for room in rooms):,} sequences of {len(rooms)} rooms"
