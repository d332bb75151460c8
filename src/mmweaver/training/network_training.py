"""Training the weaver: its recipe, its learner, and what it writes."""

import hashlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.version import __version__
from mmweaver.datasets.dataset_store import plan_text, read_plan
from mmweaver.models.environment_encoder import DEFAULT_ENCODER
from mmweaver.models.network import SceneEncoding, WeaverNetwork
from mmweaver.models.precision import exactly
from mmweaver.models.weights import WEIGHTS_FILE, WeightsCard, save_weights
from mmweaver.paths.mean_paths import Echoes
from mmweaver.paths.mean_power import MeanPower, PowerMaps
from mmweaver.paths.radar_equation import points_of
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.model_card import Figures, model_card
from mmweaver.training.network_examples import NetworkBatch, RoomExamples, examples, sample_batch
from mmweaver.training.network_loss import weaver_loss
from mmweaver.training.trainer import Draw, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import differences_db, draw_sheet

VALIDATION_SEED = 10_000  # added to the recipe's
CARD_FILE = "README.md"


@dataclass(frozen=True, kw_only=True)
class TrainingRecipe(LoopRecipe):
    """How the weaver is trained."""

    name: str = "weaver"
    batch_size: int = 3  # sequences, each of another room
    frames: int = 8  # looked at in each
    mirror: bool = True  # every second batch with left and right exchanged
    without: tuple[str, ...] = ("correction",)  # parts of the network that stay as physics has them (decision 102)
    encoder: str = DEFAULT_ENCODER  # of the room's pictures, a name in ENCODERS


class NetworkLearner(Learner):
    """The network beside the radar that turns its echoes into maps; `shown` gives the sequences to draw."""

    def __init__(self, network: WeaverNetwork, config: RadarConfig, shown: Callable[[], NetworkBatch] | None = None):
        super().__init__()
        self.network = network
        self.radar = MeanPower(config)
        self.shown = shown

    def _apply(self, fn: Any, recurse: bool = True) -> "NetworkLearner":
        """The radar's tensors go where the network goes."""
        super()._apply(fn, recurse)
        self.radar.to(self.device)
        return self

    @property
    def device(self) -> torch.device:
        return next(self.network.parameters()).device

    def terms(self, batch: NetworkBatch) -> dict[str, torch.Tensor]:
        code = self.network.encode_room(batch.view)
        moving = self.moving(code, batch)
        with exactly(batch.joints_m):
            return weaver_loss(self.radar, code.resting, moving, batch.targets)

    def moving(self, code: SceneEncoding, batch: NetworkBatch) -> Echoes:
        """Echoes of the people of a batch."""
        return self.network.moving(code, batch.joints_m, batch.velocity_mps, batch.frames)

    def predicted(self, batch: NetworkBatch) -> PowerMaps:
        """Mean maps (sequence, frame, range, other) of room, person and noise."""
        code = self.network.encode_room(batch.view)
        moving = self.moving(code, batch)
        with exactly(batch.joints_m):
            still = self.radar.maps(points_of(code.resting, self.radar.response))
            person = self.radar.maps(points_of(moving, self.radar.response))
        names = ("range_doppler", "range_azimuth", "range_elevation")
        return PowerMaps(
            **{
                name: getattr(person, name) + getattr(still, name)[:, None] + noise
                for name, noise in zip(names, self.radar.noise_maps(), strict=True)
            }
        )

    def picture(self) -> np.ndarray | None:
        if self.shown is None:
            return None
        batch = moved(self.shown(), self.device)
        return draw_sheet(batch.targets.maps, self.predicted(batch), self.radar.config)


def train(
    data: Path,
    out: Path,
    recipe: TrainingRecipe,
    *,
    start: dict[str, torch.Tensor] | None = None,
    listener: Listener | None = None,
    workplace: ComputeDevice | None = None,
    **options: Any,
) -> Trainer:
    """Trains on split `train` of a data set; what comes back holds the network that was best on `validation`.

    Goes on from `out`/checkpoint.pt where there is one. `start`: weights to fine-tune. `options` go to `Trainer`.
    Raises InputError for folders that hold no data, and where gradients stay without meaning.
    """
    options = {"is_tuning": start is not None} | options
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    validation = drawing(unseen, recipe, VALIDATION_SEED + recipe.seed)
    learner = NetworkLearner(begun(recipe, start), rooms[0].room.config, shown=lambda: validation(0, (0, 1)))
    trainer = Trainer(
        learner, recipe, out, workplace=workplace, train=drawing(rooms, recipe, recipe.seed, recipe.mirror),
        validation=validation,
        **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def begun(recipe: LoopRecipe, start: dict[str, torch.Tensor] | None) -> WeaverNetwork:
    """The network that training begins with; a recipe without parts of it leaves them alone."""
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork(recipe.without, recipe.encoder) if isinstance(recipe, TrainingRecipe) else WeaverNetwork()
    if start is not None:
        network.load_state_dict(start)
    return network


def drawing(rooms: list[RoomExamples], recipe: TrainingRecipe, seed: int, mirror: bool = False) -> Draw:
    """Batches of rooms, by step."""
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: sample_batch(rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror)


def write_weights(out: Path, data: Path, trainer: Trainer, *, start: dict[str, torch.Tensor] | None = None) -> Path:
    """Writes `out`/weights.safetensors and the page that goes with it, README.md; gives the weights' path."""
    plan = hashlib.sha256(plan_text(data).encode()).hexdigest()
    file = save_trained(out, trainer, plan)
    told = f"Made up by `mmweaver dataset` ({_told(read_plan(data))}). Trained on {_counted(examples(data, 'train'))}."
    judged = f"Mean difference in dB of power maps on {_counted(examples(data, 'validation'))} of kinds not trained on;"
    card = card_of(trainer, plan)
    figures = compared(trainer, begun(trainer.recipe, start))
    page = model_card(card, file, data=told, judged_on=f"{judged} {EXPLAINED}", figures=figures)
    with atomic_file(out / CARD_FILE) as partial:
        partial.write_text(page, encoding="utf-8")
    return file


EXPLAINED = (
    "0 would be perfect, and what predicts a mean is 4 to 5 dB from any single draw of phases, however right it is."
)


def save_trained(out: Path, trainer: Trainer, dataset_sha256: str, **more: str) -> Path:
    """Writes `out`/weights.safetensors alone."""
    learner = trainer.learner
    assert isinstance(learner, NetworkLearner)
    file = out / WEIGHTS_FILE
    save_weights(file, learner.network, card_of(trainer, dataset_sha256, **more))
    return file


def card_of(trainer: Trainer, dataset_sha256: str, **more: str) -> WeightsCard:
    """What is written into the weights of a run."""
    learner = trainer.learner
    assert isinstance(learner, NetworkLearner)
    return WeightsCard(
        recipe=trainer.recipe.name, licence=more.get("licence", "MIT"), dataset_sha256=dataset_sha256,
        radar=learner.radar.config.name, steps=trainer.step, seed=trainer.recipe.seed,
        validation_loss=trainer.best.value, mmweaver_version=__version__, tuned_from=more.get("tuned_from", ""),
        settings=asdict(trainer.recipe) | {"precision": trainer.workplace.precision},
    )  # fmt: skip


def compared(trainer: Trainer, start: WeaverNetwork) -> Figures:
    """Differences in dB on the validation batches: of the network, of what it began with, of an empty map."""
    learner = trainer.learner
    assert isinstance(learner, NetworkLearner)
    rows: dict[str, list[dict[str, float]]] = {}
    trained = learner.network
    with torch.inference_mode():
        for batch in trainer.validation_batches():
            truth, own = batch.targets.maps, learner.predicted(batch)
            learner.network = start.to(learner.device).eval()
            before = learner.predicted(batch)
            learner.network = trained
            nothing = PowerMaps(**{name: 0 * value for name, value in vars(truth).items()})
            for who, maps in (("this network", own), ("what it began with", before), ("empty maps", nothing)):
                rows.setdefault(who, []).append(differences_db(truth, maps))
    return {who: {name: float(np.mean([row[name] for row in each])) for name in each[0]} for who, each in rows.items()}


def _counted(rooms: list[RoomExamples]) -> str:
    return f"{sum(len(room.indices) for room in rooms):,} sequences of {len(rooms)} rooms"


def _told(plan: dict[str, Any]) -> str:
    return (
        f"{len(plan['kinds'])} kinds of rooms, {plan['num_layouts']} layouts of each, {plan['sequences_a_room']}"
        f" sequences of {plan['num_frames']} frames in every room, radar {plan['radar']}, seed {plan['seed']}"
    )
