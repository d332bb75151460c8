"""Training of recipe `paper_power`: fields of log power by a hypernetwork, with the loss of recipe `weaver`.

Its encoders are those of the weights that are included and stay as they are; hypernetwork and fields are trained.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import Page
from mmweaver.training.network_examples import RoomExamples, examples, reflected_joints, reflected_scene, sample_batch
from mmweaver.training.network_training import VALIDATION_SEED, NetworkLearner, compare_with_start
from mmweaver.training.trained_weights import write_recipe_weights
from mmweaver.training.trainer import BatchSampler, Listener, LoopRecipe, Trainer
from studies.paper.power_network import RECIPE, PowerNetwork

POWER = Page(
    unit="dB",
    about="""The paper's idea with a target that can be learnt: a photo of a room with depth and a person's joints in,
fields of radar cross section out, implicit neural representations that a hypernetwork writes. Read at the cells of any
radar; each cell becomes a scatterer of sampled phase. Kept to be compared with; recipe weaver is nearer to the truth.

```python
from studies.paper.power_method import PowerFields  # from a clone

weaver = Weaver(method=PowerFields("weights.safetensors"))
```""",
    limits="""- Read together with photo and joints, from which its coordinates are counted; radars at the camera alone.
- The person's reflections in walls are not there.
- Details finer than 5 cm, 0.28 m/s and an eighth of a cosine are smooth, whatever radar reads them.
- One radar ({radar}); others read the same fields and have not been evaluated.""",
)


@dataclass(frozen=True, kw_only=True)
class PowerRecipe(LoopRecipe):
    """Hyperparameters of recipe `paper_power`."""

    name: str = RECIPE
    steps: int = 3000
    batch_size: int = 3  # sequences, each of a different room
    frames: int = 3  # sampled from each sequence
    warm_up_steps: int = 30
    mirror: bool = True  # reflect every second batch left-right
    is_anchored: bool = True  # coordinates are counted from photographed surfaces and from the body, too
    reads_codes: bool = True  # else the hypernetwork writes the same for all, to see what codes are worth


def train_power(
    data: Path, out: Path, recipe: PowerRecipe, *, start: dict[str, Tensor] | None = None,
    listener: Listener | None = None, compute: ComputeDevice | None = None, **options: Any,
) -> Trainer:  # fmt: skip
    """Trains on split `train`, or continues from `out`/checkpoint.pt; the trainer holds what was best on `validation`.

    `start`: weights to fine-tune. `options` go to `Trainer`. Raises InputError for folders without data.
    """
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    validation = _sampler(unseen, recipe, VALIDATION_SEED + recipe.seed)
    network = initial_power_network(recipe)
    if start is None:
        measure_codes(network, rooms if recipe.reads_codes else [])
    else:
        network.load_state_dict(start)
    learner = NetworkLearner(network, rooms[0].room.config, shown=lambda: validation(0, (0, 1)))
    trainer = Trainer(
        learner, recipe, out, compute=compute,
        batches=(_sampler(rooms, recipe, recipe.seed, recipe.mirror), validation),
        is_tuning=start is not None, **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def initial_power_network(recipe: PowerRecipe) -> PowerNetwork:
    """The network that training starts from, but for what is measured over the training set."""
    torch.manual_seed(recipe.seed)
    network = PowerNetwork(is_anchored=recipe.is_anchored)
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


def _sampler(rooms: list[RoomExamples], recipe: PowerRecipe, seed: int, mirror: bool = False) -> BatchSampler:
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: sample_batch(rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror)


def write_power_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes `out`/weights.safetensors and its model card; returns the path of the weights."""
    assert isinstance(trainer.recipe, PowerRecipe)
    figures = compare_with_start(trainer, initial_power_network(trainer.recipe))
    return write_recipe_weights(out, data, trainer, splits=("train",), page=POWER, figures=figures)
