"""Fine-tuning on a few recordings of the user.

With joints the entire network is tuned; without, only the heads that correct the cross section of static surfaces, so
that echoes of people stay bit-identical.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.core.tensor_files import sha256_of
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.propagation.mean_power import MeanEchoes, PowerMaps
from mmweaver.propagation.radar_equation import points_of
from mmweaver.propagation.receiver import agreeing_gain
from mmweaver.training.captures import SPLIT, Capture, RecordedRoom, rooms_of
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import WEAVER
from mmweaver.training.network_examples import NetworkBatch, RoomExamples, sample_batch
from mmweaver.training.network_training import (
    EXPLAINED,
    VALIDATION_SEED,
    NetworkLearner,
    TrainingRecipe,
    compare_with_start,
    initial_network,
)
from mmweaver.training.trained_weights import weights_card, write_trained
from mmweaver.training.trainer import BatchSampler, Listener, Trainer

STATIC_HEADS = ("point", "face")
STATIC_LEARNING_RATE = 5e-3  # for these two small heads, if no capture has joints
PLACEHOLDER_M = (0.0, 2.5, -0.5)  # position of unknown people, whose echoes are multiplied by zero


@dataclass(frozen=True, kw_only=True)
class CaptureRecipe(TrainingRecipe):
    """Hyperparameters of fine-tuning: few, small steps, since there is little data."""

    name: str = "weaver, tuned"
    steps: int = 300
    batch_size: int = 2
    learning_rate: float = 2e-4
    warm_up_steps: int = 20
    validate_every: int = 25
    validation_batches: int = 4
    patience: int = 6
    corrects_surfaces: bool = True


def recipe_for(captures: Sequence[Capture], **given: Any) -> CaptureRecipe:
    """Chooses the recipe for captures with or without joints.

    Args:
        captures: The captures.
        **given: Hyperparameters that override the recipe's.

    Returns:
        The recipe.
    """
    if all(one.pose is None for one in captures):
        given = {"learning_rate": STATIC_LEARNING_RATE} | given
    return CaptureRecipe(**given)


@dataclass(frozen=True, kw_only=True)
class CaptureBatch(NetworkBatch):
    """A batch of captures; for people that are not `known`, the maps are those of the static room."""

    known: Tensor  # (sequence,) 0 or 1


class CaptureLearner(NetworkLearner):
    """Learns from captures; unknown people have no echo."""

    def __init__(self, network: WeaverNetwork, config: RadarConfig, noise_power: float, *, everything: bool):
        """Selects the parameters that are trained.

        Args:
            network: The network.
            config: The radar.
            noise_power: Noise power of the recordings in mW per cell.
            everything: Whether the entire network is tuned, not just the heads of static surfaces.
        """
        super().__init__(network, config)
        self.radar.noise = noise_power
        for name, parameter in network.named_parameters():
            parameter.requires_grad_(everything or name.split(".")[0] in STATIC_HEADS)

    def moving(self, code: Any, batch: NetworkBatch) -> MeanEchoes:
        """Mean echoes of the people in a batch, zero for unknown people."""
        echoes = super().moving(code, batch)
        if not isinstance(batch, CaptureBatch):
            return echoes
        return replace(echoes, cross_section_m2=echoes.cross_section_m2 * batch.known[:, None, None])


@dataclass(frozen=True, kw_only=True)
class TuningResult:
    """Result of fine-tuning, with the calibration of the recordings."""

    trainer: Trainer[CaptureLearner]
    rooms: list[RecordedRoom]
    held_out: RecordedRoom | None  # None for a single capture
    loss_before: float  # validation loss of the initial weights
    gain: float  # of uncalibrated recordings, in sqrt(mW) per count; otherwise 1


def tune(
    captures: Sequence[Capture],
    out: Path,
    recipe: CaptureRecipe,
    *,
    start: dict[str, Tensor],
    listener: Listener | None = None,
    compute: ComputeDevice | None = None,
    **options: Any,
) -> TuningResult:
    """Fine-tunes weights on captures, or resumes from `out`/checkpoint.pt.

    Uncalibrated recordings share one gain, at which the initial weights agree with them best.

    Args:
        captures: Captures of one radar; the last one is held out for validation unless it is the only one.
        out: Folder of the run.
        recipe: Hyperparameters, as chosen by `recipe_for`.
        start: Initial weights.
        listener: Called with the progress of each step. Default: none.
        compute: Device, precision and process. Default: CPU in float32.
        **options: Further arguments of `Trainer`.

    Returns:
        The trainer with the best network, the calibrated rooms, and the loss of the initial weights.

    Raises:
        InputError: If radars differ, or training diverges.
    """
    network = initial_network(recipe, start)
    rooms = rooms_of(captures)
    gain = 1.0
    if not all(room.is_calibrated for room in rooms):
        gain = estimate_gain(network, [room for room in rooms if not room.is_calibrated])
        rooms = [room if room.is_calibrated else room.calibrated(gain) for room in rooms]
    noise = float(np.median([room.noise_power for room in rooms]))
    held_out = rooms[-1] if len(rooms) > 1 else None
    used = rooms[:-1] if held_out is not None else rooms
    everything = any(room.has_joints for room in used)
    learner = CaptureLearner(network, rooms[0].config, noise, everything=everything)
    maps = learner.radar.noise_maps()
    validation = _batch_sampler([held_out or rooms[0]], recipe, VALIDATION_SEED + recipe.seed, maps)
    learner.shown = lambda: validation(0, (0, 1))
    trainer = Trainer(
        learner,
        recipe,
        out,
        batches=(_batch_sampler(used, recipe, recipe.seed, maps), validation),
        compute=compute,
        is_tuning=True,
        **options,
    )
    before = _loss_of(trainer, initial_network(recipe, start))
    trainer.run(listener)
    return TuningResult(trainer=trainer, rooms=rooms, held_out=held_out, loss_before=before, gain=gain)


def write_tuned(out: Path, tuned: TuningResult, *, start: dict[str, Tensor], licence_of_start: str = "MIT") -> Path:
    """Writes weights.safetensors and its model card README.md.

    Args:
        out: Folder of the run.
        tuned: Result of `tune`.
        start: Initial weights.
        licence_of_start: Their licence. Default: MIT.

    Returns:
        Path of the weights.
    """
    digest = hashlib.sha256("".join(room.sha256 for room in tuned.rooms).encode()).hexdigest()
    trainer, used = tuned.trainer, len(tuned.rooms) - (tuned.held_out is not None)
    card = weights_card(
        trainer,
        dataset_sha256=digest,
        radar=trainer.learner.radar.config.name,
        tuned_from=sha256_of(start),
        licence=licence_of_start,
    )
    known = sum(room.has_joints for room in tuned.rooms[:used])
    held_out = "One held-out capture" if tuned.held_out is not None else "The captures themselves (one only)"
    return write_trained(
        out,
        trainer,
        card,
        evaluated_on=f"{held_out}; {EXPLAINED}",
        page=WEAVER,
        data=f"{used} captures of the user's own, {known} of them with joints, on top of the data of the initial"
        " weights.",
        figures=compare_with_start(trainer, initial_network(trainer.recipe, start)),
    )


def _loss_of(trainer: Trainer[CaptureLearner], network: WeaverNetwork) -> float:
    """Validation loss of another network."""
    learner = trainer.learner
    own, learner.network = learner.network, network.to(learner.device)
    loss = trainer.validation_loss()
    learner.network = own
    return loss


def estimate_gain(network: WeaverNetwork, rooms: Sequence[RecordedRoom]) -> float:
    """Estimates the amplitude gain at which recordings and network agree on static clutter.

    Args:
        network: The network.
        rooms: Uncalibrated recordings.

    Returns:
        Median gain in sqrt(mW) per count.
    """
    learner = NetworkLearner(network, rooms[0].config).eval()
    maps = []
    for room in rooms:
        one = RoomExamples(room, SPLIT)
        with torch.inference_mode():
            scene = one.scene[None]
            static = learner.network.encode_room(scene).static
            expected = learner.radar.maps(points_of(static, learner.radar.response)).range_azimuth[0]
        maps.append((expected, one.static.range_azimuth))
    return agreeing_gain(maps)


def _batch_sampler(
    rooms: list[RecordedRoom], recipe: CaptureRecipe, seed: int, noise: tuple[float, float, float]
) -> BatchSampler:
    pool = [RoomExamples(room, SPLIT) for room in rooms]

    def draw(step: int, share: tuple[int, int]) -> CaptureBatch:
        batch = sample_batch(pool, seed, step, size=recipe.batch_size, frames=recipe.frames, share=share)
        return _mask_unknown_people(batch, noise)

    return draw


def _mask_unknown_people(batch: NetworkBatch, noise: tuple[float, float, float]) -> CaptureBatch:
    """Replaces the maps of sequences without joints by the static room plus noise."""
    known = torch.isfinite(batch.joints_m).flatten(1).all(dim=1)
    place = torch.tensor(PLACEHOLDER_M).expand(NUM_JOINTS, 3) + 0.1 * torch.eye(NUM_JOINTS, 3)
    each = known[:, None, None, None]
    maps: dict[str, Tensor] = {}
    for own, level in zip(fields(PowerMaps), noise, strict=True):
        measured, static = getattr(batch.targets.maps, own.name), getattr(batch.targets.static, own.name)
        maps[own.name] = torch.where(each, measured, (static + level)[:, None].expand_as(measured))
    return CaptureBatch(
        scene=batch.scene,
        joints_m=torch.where(each, batch.joints_m, place),
        velocity_mps=torch.where(each, batch.velocity_mps, torch.zeros(())),
        frames=batch.frames,
        targets=replace(batch.targets, maps=PowerMaps(**maps)),
        known=known.float(),
    )
