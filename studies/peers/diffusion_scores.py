"""RF-Diffusion's kind of generator, small and trained here: does it make signals, or pass the truth on?

    python -m studies run diffusion_scores --data DATASET --runs build/diffusion

Trains `signal_diffusion` on the data set's training rooms (resumes where it was stopped) and scores it in rooms of
unseen kinds, next to zeros, the training mean, the nearest training pose and the oracle. `diffusion_from_noise`
generates from joints and photo alone; `diffusion_truth_given` starts as the published evaluation does, from the ground
truth at weight 0.925. `truth_with_noise` is that start itself, before any network.
"""

import argparse
import math
from dataclasses import asdict, dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.metrics.scorecard import METRICS, scorecard
from mmweaver.training.device import Share
from mmweaver.training.trainer import Learner, LoopRecipe, Trainer
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, Case, Method, cases_of, interval, nearest, simulated, training_mean
from studies.network.room_cache import RoomCache
from studies.peers.signal_diffusion import PICTURE, FrameBatch, SignalDiffusion, mixed, sampled
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db", "cssim", "psnr_db")
TRUTH_WEIGHT = 0.925  # of the published evaluation
FRAMES = 4  # of each sequence of a batch


@dataclass(frozen=True, kw_only=True)
class DiffusionRecipe(LoopRecipe):
    """Hyperparameters of the small diffusion."""

    name: str = "signal_diffusion"
    steps: int = 2000
    batch_size: int = 6
    learning_rate: float = 1e-3
    warm_up_steps: int = 100
    validate_every: int = 250
    validation_batches: int = 4


class DiffusionRoom:
    """One stored room as the diffusion sees it."""

    def __init__(self, room: StoredRoom, split: str = "train"):
        self.room = room
        self.indices = [index for index, name in enumerate(room.split) if name == split]

    @cached_property
    def picture(self) -> Tensor:
        """The photo in few pixels, (960,): colour, distance in 4 m, and whether that is known."""
        photo = self.room.photo
        depth = np.nan_to_num(photo.depth_m)
        channels = np.concatenate([photo.rgb / 255.0, depth[..., None] / 4, (depth > 0)[..., None]], axis=-1)
        whole = torch.from_numpy(channels).float().permute(2, 0, 1)
        return torch.nn.functional.adaptive_avg_pool2d(whole, PICTURE[1:]).flatten()

    def motion(self, index: int) -> Tensor:
        """Joints and velocities (frame, 132)."""
        parts = (self.room.joints_m[index], self.room.joint_velocity_mps[index])
        return torch.from_numpy(np.concatenate(parts, axis=-1)).float().flatten(1) / 2

    def signal(self, index: int, frames: np.ndarray) -> Tensor:
        """Frames in slow time, (frame, loop, range, antenna), in sqrt(mW)."""
        return slow_time(self.room.cube(index, frames).values)


def slow_time(values: np.ndarray) -> Tensor:
    """Cube values (frame, range, doppler, antenna) -> windowed loops (frame, loop, range, antenna)."""
    return torch.fft.ifft(torch.from_numpy(values), dim=2, norm="ortho").transpose(1, 2)


def cube_of(signal: Tensor) -> np.ndarray:
    """The inverse of `slow_time`."""
    return torch.fft.fft(signal.transpose(1, 2), dim=2, norm="ortho").to(torch.complex64).numpy()


def unit_of(rooms: list[DiffusionRoom], most: int = 24) -> Tensor:
    """Root mean square of each range bin over some training frames, (range,)."""
    frames = torch.cat([one.signal(one.indices[0], np.array([0])) for one in rooms[:most]])
    return frames.abs().square().mean(dim=(0, 1, 3)).sqrt().clamp(min=1e-30)


def sample_frames(rooms: list[DiffusionRoom], unit: Tensor, seed: int, step: int, *, size: int, share: Share):
    """A batch of frames of `size` sequences, with time and noise; determined by seed and step."""
    signal, motion, picture = [], [], []
    for number in range(share[0], size, share[1]):
        rng = stream(seed, "diffusion batch", step, number)
        one = rooms[int(rng.integers(len(rooms)))]
        index = one.indices[int(rng.integers(len(one.indices)))]
        frames = np.sort(rng.choice(len(one.room.joints_m[index]), FRAMES, replace=False))
        signal.append(one.signal(index, frames) / unit[:, None])
        motion.append(one.motion(index)[frames])
        picture.append(one.picture.expand(FRAMES, -1))
    whole = torch.cat(signal)
    rng = stream(seed, "diffusion noise", step, share[0])
    return FrameBatch(
        signal=whole, motion=torch.cat(motion), picture=torch.cat(picture),
        time=torch.from_numpy(rng.random(len(whole))).float(), noise=white(rng, whole.shape),
    )  # fmt: skip


def white(rng: np.random.Generator, shape: Any) -> Tensor:
    """Complex noise of unit variance."""
    return torch.view_as_complex(torch.from_numpy(rng.standard_normal((*shape, 2), np.float32)) / math.sqrt(2))


class DiffusionLearner(Learner):
    """The network with its loss: the squared error of what it restores, over the energy of the signal."""

    def __init__(self, network: SignalDiffusion):
        super().__init__()
        self.network = network

    def terms(self, batch: FrameBatch) -> dict[str, Tensor]:
        noisy = mixed(batch.signal, batch.noise, batch.time)
        error = self.network(noisy, batch.time, batch.motion, batch.picture) - batch.signal
        return {"squared_error": error.abs().square().mean()}


def trained(rooms: list[StoredRoom], out: Path, recipe: DiffusionRecipe) -> tuple[SignalDiffusion, Tensor]:
    """The network best on split `validation`, and the unit of its signals; continues from `out`/checkpoint.pt."""
    train, unseen = (
        [DiffusionRoom(room, split) for room in rooms if split in room.split] for split in ("train", "validation")
    )
    unit = unit_of(train)
    torch.manual_seed(recipe.seed)
    learner = DiffusionLearner(SignalDiffusion(rooms[0].config))
    samplers = [
        partial(_batch, some, unit, recipe.seed + extra, recipe.batch_size)
        for some, extra in ((train, 0), (unseen, 10_000))
    ]
    Trainer(learner, recipe, out, train=samplers[0], validation=samplers[1]).run(
        lambda progress: None if progress.validation is None else print(progress.step, progress.validation, flush=True)
    )
    learner.eval()
    return learner.network, unit


def _batch(rooms: list[DiffusionRoom], unit: Tensor, seed: int, size: int, step: int, share: Share) -> FrameBatch:
    return sample_frames(rooms, unit, seed, step, size=size, share=share)


def generated(network: SignalDiffusion, unit: Tensor, *, is_truth_given: bool, is_restored: bool = True) -> Method:
    """The diffusion from noise, or from the ground truth with noise; `is_restored`: whether the network runs at all."""

    def method(case: Case) -> RadarCube:
        one, truth = DiffusionRoom(case.room, case.spec.split), case.room.cube(case.index)
        signal = slow_time(truth.values) / unit[:, None]
        # one noise for all frames, so that what stands still may stay the same
        noise = white(stream(case.index, "diffusion start"), signal.shape[1:])[None].expand_as(signal)
        begin = math.acos(TRUTH_WEIGHT) / (math.pi / 2) if is_truth_given else 1.0
        start = mixed(signal, noise, torch.full((len(signal),), begin)) if is_truth_given else noise
        if is_restored:
            picture = one.picture.expand(len(signal), -1)
            with torch.inference_mode():
                start = sampled(network, start, begin, one.motion(case.index), picture)
        return replace(truth, values=cube_of(start * unit[:, None]))

    return method


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="of mmweaver dataset --board ideal")
    parser.add_argument("--runs", type=Path, required=True, help="folder for checkpoint and scores, to go on from")
    parser.add_argument("--steps", type=int, default=DiffusionRecipe().steps)
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--most", type=int, default=16, help="rooms, sampled at random")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    recipe = DiffusionRecipe(steps=options.steps)
    network, unit = trained(rooms, options.runs, recipe)
    methods: dict[str, Method] = {
        "diffusion_from_noise": generated(network, unit, is_truth_given=False),
        "diffusion_truth_given": generated(network, unit, is_truth_given=True),
        "truth_with_noise": generated(network, unit, is_truth_given=True, is_restored=False),
        "training_mean": training_mean(rooms),
        "nearest_training_pose": nearest(rooms),
        "realization": simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1),
    }
    cases = cases_of(rooms, options.split, 1, plan, 0, options.most)
    cache = RoomCache(options.runs / "scores", {"data_plan": plan, "recipe": asdict(recipe), "columns": COLUMNS})
    each = [cache.figures(case.room.folder.name, partial(scores_of, case, methods)) for case in cases]
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    size = sum(parameter.numel() for parameter in network.parameters())
    rows = complete_rows(
        [row_of(name, each, names) for name in each[0]], dataset={**dataset_of(options.data), "split": options.split},
        seeds=[recipe.seed], baselines=("zeros", "training_mean", "nearest_training_pose"), oracles=("realization",),
        unknown={"seconds": "see the manifest: training and all rows together"},
    )  # fmt: skip
    run.write(
        "diffusion_scores", options.split,
        config={"data_plan": plan, "recipe": asdict(recipe), "parameters": size}, rows=rows,
    )  # fmt: skip
    for row in rows:
        print(f"{row['method']:24}", *(f"{name} {one['value']:.3f}" for name, one in row["metrics"].items()))


def scores_of(case: Case, methods: dict[str, Method]) -> dict[str, dict[str, float]]:
    """{row: {column: value}} of one case."""
    truth, scores = case.room.cube(case.index), {}
    for name, method in methods.items():
        card = scorecard(method(case), truth)
        scores.setdefault("zeros", {column: card.baselines["zeros"][column] for column in COLUMNS})
        scores[name] = {column: card.prediction[column] for column in COLUMNS}
    return scores


def row_of(method: str, each: list[dict[str, dict[str, float]]], rooms: list[str]) -> dict[str, Any]:
    """Means and intervals over rooms."""
    metrics = {}
    for column in COLUMNS:
        mean, low, high = interval(np.array([one[method][column] for one in each]), rooms)
        metrics[column] = {"value": mean, "interval_95": [low, high], "unit": METRICS[column].unit}
    return {"method": method, "n": len(rooms), "num_rooms": len(set(rooms)), "metrics": metrics}
