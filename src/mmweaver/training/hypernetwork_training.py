"""Training of the hypernetwork, recipe `hypernetwork`: one recipe, one loop, two targets.

`signal` is the paper as written: complex I/Q signals, with the paper's loss and sampling. `power` is what can be
learned: fields of log power, with the loss of recipe `weaver`; its encoders are those of the included weights and stay
as they are. Reference: paper, "Model Training"; docs/paper.md.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.inr.networks import ModulatedINR
from mmweaver.models.activity_network import ActivityNetwork, load_activity
from mmweaver.models.hypernetwork import HyperNetwork, unit_sqrt_mw
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.precision import exactly
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import POWER, SIGNAL, load_weights, shipped_weights
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import Figures, Page
from mmweaver.training.network_examples import (
    RoomExamples,
    examples,
    power_maps,
    reflected_joints,
    reflected_scene,
    sample_batch,
)
from mmweaver.training.network_training import VALIDATION_SEED, NetworkLearner, compare_with_start
from mmweaver.training.signal_examples import SignalBatch, SignalRoomExamples, sample_signal_batch, signal_rooms
from mmweaver.training.signal_loss import signal_loss
from mmweaver.training.trained_weights import write_recipe_weights
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import MAX_ROWS, draw_sheet

PAGES = {
    SIGNAL: Page(
        unit="",
        about="""The paper's network as the paper trains it, kept for comparison: a photo of a room with depth and a
person's joints in, the weights of an implicit representation of the complex signal out. For use take recipe weaver.

    mmweaver generate --demo --weights . --out walk/""",
        limits="- Where its loss is that of all zeros it has collapsed: its signals hold hardly any energy.\n"
        "- One person; one radar ({radar}).",
    ),
    POWER: Page(
        unit="dB",
        about="""The paper's idea with a target that can be learned: a photo of a room with depth and a person's joints
in, fields of radar cross section out, implicit neural representations that a hypernetwork writes. Read at the cells of
any radar; each cell becomes a scatterer of sampled phase. Recipe weaver is nearer to the ground truth.

    mmweaver generate --demo --weights . --out walk/""",
        limits="""- Read together with photo and joints, from which its coordinates are counted; radars at the
  camera alone.
- The person's reflections in walls are not there.
- Details finer than 5 cm, 0.28 m/s and an eighth of a cosine are smooth, whatever radar reads them.
- One radar ({radar}); others read the same fields and have not been evaluated.""",
    ),
}


@dataclass(frozen=True, kw_only=True)
class HypernetworkRecipe(LoopRecipe):
    """Hyperparameters of recipe `hypernetwork`; `for_target` gives those of a target."""

    name: str = "hypernetwork"
    target: Literal["signal", "power"] = POWER
    steps: int = 3000
    batch_size: int = 3  # sequences, each of a different room
    frames: int = 3  # target power: sampled from each sequence
    warm_up_steps: int = 30
    mirror: bool = True  # target power: reflect every second batch left-right
    reads_codes: bool = True  # target power: else the same is written for all, to see what codes are worth

    @classmethod
    def for_target(cls, target: str, **settings: Any) -> "HypernetworkRecipe":
        """The recipe of a target; of signal, Adam at 1e-4 without schedule or early end, as the paper states."""
        if target == SIGNAL:
            paper = {
                "steps": 6000, "batch_size": 4, "learning_rate": 1e-4, "warm_up_steps": 0, "is_cosine": False,
                "weight_decay": 0.0, "largest_gradient": None, "validate_every": 200, "patience": 1_000_000,
            }  # fmt: skip
            settings = paper | settings
        return cls(target=target, **settings)  # ty: ignore[invalid-argument-type]


def train_hypernetwork(
    data: Path, out: Path, recipe: HypernetworkRecipe, *, features: Path | None = None,
    start: dict[str, Tensor] | None = None, listener: Listener | None = None, compute: ComputeDevice | None = None,
    **options: Any,
) -> Trainer[Any]:  # fmt: skip
    """Trains on split `train` of a data set of rooms, or resumes from `out`/checkpoint.pt.

    Args:
        data: Folder of the data set.
        out: Folder of the run.
        recipe: Hyperparameters.
        features: Weights of recipe `activity`, whose features the perceptual loss of target signal compares. Default:
            an untrained network's.
        start: Weights to fine-tune.
        listener: Called with the progress of each step.
        compute: Device, precision and process. Default: CPU in float32.
        **options: Further arguments of `Trainer`.

    Returns:
        The trainer with the best network on split `validation`.

    Raises:
        InputError: For folders without data, and foreign weights.
    """
    make = _signal_learner if recipe.target == SIGNAL else _power_learner
    device = str((compute or ComputeDevice()).device)
    learner, batches = make(data, recipe, start, features, device)
    trainer = Trainer(
        learner, recipe, out, compute=compute, batches=batches, is_tuning=start is not None, **options
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def write_hypernetwork_weights(out: Path, data: Path, trainer: Trainer[Any]) -> Path:
    """Writes weights.safetensors and its model card README.md.

    Args:
        out: Folder of the run.
        data: Folder of the data set.
        trainer: The finished run.

    Returns:
        Path of the weights.
    """
    recipe = trainer.recipe
    assert isinstance(recipe, HypernetworkRecipe), "a recipe of this network"
    if recipe.target == SIGNAL:
        figures = _validation_figures(trainer)
    else:
        figures = compare_with_start(trainer, initial_power_network(recipe))
    return write_recipe_weights(out, data, trainer, splits=("train",), page=PAGES[recipe.target], figures=figures)


# target signal ------------------------------------------------------------------------------------------------------
class SignalLearner(Learner):
    """A hypernetwork with the paper's loss; `shown` returns the rooms whose first sequences its picture shows."""

    def __init__(
        self,
        network: HyperNetwork,
        perceiver: ActivityNetwork,
        config: RadarConfig,
        shown: Callable[[], list[SignalRoomExamples]] = list,
    ):
        super().__init__()
        self.network, self.config, self.shown = network, config, shown
        self._perceiver = (perceiver.requires_grad_(False),)  # no module of this one: its weights are not trained
        self._inr = (ModulatedINR(1),)  # whose weights are written

    def _apply(self, fn: Any, recurse: bool = True) -> "SignalLearner":
        """Moves the feature network along with this one."""
        super()._apply(fn, recurse)
        self._perceiver[0].to(next(self.network.parameters()).device)
        return self

    def terms(self, batch: SignalBatch) -> dict[str, Tensor]:
        """Terms of `signal_loss`."""
        return self._cost(self.patches(batch), batch)

    def figures(self, batch: SignalBatch) -> dict[str, Tensor]:
        """The loss of all zeros, and error and energy over the energy of the ground truth: they reveal a collapse."""
        made, energy = self.patches(batch), batch.truth.abs().square().sum()
        nothing = torch.stack(list(self._cost(torch.zeros_like(made), batch).values())).sum()
        return {
            **{f"own_{name}": term for name, term in self._cost(made, batch).items()}, "zeros_loss": nothing,
            "nmse": (made - batch.truth).abs().square().sum() / energy, "energy": made.abs().square().sum() / energy,
        }  # fmt: skip

    def picture(self) -> np.ndarray | None:
        """Maps of ground truth and network on the rooms of `shown`, or None."""
        rooms = self.shown()
        if not rooms:
            return None
        true, made = [], []
        for one in rooms:
            index = one.indices[0]
            joints, velocity = one.room.joints_m[index], one.room.joint_velocity_mps[index]
            middle = np.array([len(joints) // 2])
            cube = self.network.field(one.image, self.config, joints, velocity).cube()
            true.append(power_maps(one.room.cube(index, middle).values, self.config))
            made.append(power_maps(cube.values[middle], self.config))
        return draw_sheet(PowerMaps.stack(true), PowerMaps.stack(made), self.config, made="network")

    def patches(self, batch: SignalBatch) -> Tensor:
        """The signal at the coordinates of a batch, shaped as its ground truth (sequence, 2, range, doppler, antenna);
        weights in mixed precision, values of the field in float32."""
        theta, gamma, beta = self.network(batch.image, batch.motion)
        with exactly(theta):
            theta, gamma, beta = theta.float(), gamma.float(), beta.float()
            which = torch.arange(len(theta), device=theta.device)[:, None]
            x = batch.points[:, None].expand(-1, batch.frames.shape[1], -1, -1)
            pairs = self._inr[0](
                x, theta=theta[:, None], gamma=gamma[which, batch.frames], beta=beta[which, batch.frames]
            )
            return torch.view_as_complex(pairs.contiguous()).view(batch.truth.shape)

    def _cost(self, made: Tensor, batch: SignalBatch) -> dict[str, Tensor]:
        with exactly(made):
            return signal_loss(made, batch.truth, batch.span, self._perceiver[0], unit_sqrt_mw(self.config))


def _signal_learner(
    data: Path, recipe: HypernetworkRecipe, start: dict[str, Tensor] | None, features: Path | None, device: str
) -> tuple[SignalLearner, tuple[BatchSampler, BatchSampler]]:
    rooms, unseen = signal_rooms(data, "train", device), signal_rooms(data, "validation", device)
    config = rooms[0].room.config
    torch.manual_seed(recipe.seed)
    perceiver = ActivityNetwork(config).eval() if features is None else load_activity(features, config)
    network = HyperNetwork()
    if start is not None:
        network.load_state_dict(start)

    def drawn(rooms: list[SignalRoomExamples], seed: int) -> BatchSampler:
        return lambda step, share: sample_signal_batch(rooms, seed, step, size=recipe.batch_size, share=share)

    learner = SignalLearner(network, perceiver, config, shown=lambda: unseen[:MAX_ROWS])
    return learner, (drawn(rooms, recipe.seed), drawn(unseen, VALIDATION_SEED + recipe.seed))


def _validation_figures(trainer: Trainer[Any]) -> Figures:
    """The best validation, and what all zeros score there."""
    own = trainer.best.figures
    network = {"loss": trainer.best.value, "squared_error_over_energy": own["nmse"], "energy_over_true": own["energy"]}
    zeros = {"loss": own["zeros_loss"], "squared_error_over_energy": 1.0, "energy_over_true": 0.0}
    return {"this network": network, "all zeros": zeros}


# target power -------------------------------------------------------------------------------------------------------
def _power_learner(
    data: Path, recipe: HypernetworkRecipe, start: dict[str, Tensor] | None, features: Path | None, device: str
) -> tuple[NetworkLearner, tuple[BatchSampler, BatchSampler]]:
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    validation = _sampler(unseen, replace(recipe, mirror=False), VALIDATION_SEED + recipe.seed)
    network = initial_power_network(recipe)
    if start is None:
        measure_codes(network, rooms if recipe.reads_codes else [])
    else:
        network.load_state_dict(start)
    learner = NetworkLearner(network, rooms[0].room.config, shown=lambda: validation(0, (0, 1)))
    return learner, (_sampler(rooms, recipe, recipe.seed), validation)


def initial_power_network(recipe: HypernetworkRecipe) -> PowerNetwork:
    """The network that training starts from, but for what is measured over the training set."""
    torch.manual_seed(recipe.seed)
    network = PowerNetwork()
    weaver, _ = load_weights(shipped_weights())
    network.environment.load_state_dict(weaver.environment.state_dict())
    network.pose.load_state_dict(weaver.pose.state_dict())
    return network


def measure_codes(network: PowerNetwork, rooms: list[RoomExamples]) -> None:
    """Measures how codes of rooms and poses differ over a training set and its reflection; none without rooms."""
    env, pose = [], []
    with torch.no_grad():
        for one in rooms:
            motion = [torch.from_numpy(part[one.indices]) for part in (one.room.joints_m, one.room.joint_velocity_mps)]
            scene = SceneTensors.stack([one.scene])
            reflected = [reflected_joints(part) for part in motion]
            env += [network.environment(view.image)[0] for view in (scene, reflected_scene(scene))]
            pose += [network.pose_codes(*way).flatten(0, 1) for way in (motion, reflected)]
    for whitening, codes in ((network.env_whitening, env), (network.pose_whitening, pose)):
        whitening.measure(torch.cat(codes) if codes else torch.zeros(1, len(whitening.mean)))


def _sampler(rooms: list[RoomExamples], recipe: HypernetworkRecipe, seed: int) -> BatchSampler:
    size, frames, mirror = recipe.batch_size, recipe.frames, recipe.mirror
    return lambda step, share: sample_batch(rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror)
