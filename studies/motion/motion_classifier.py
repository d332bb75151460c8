"""Classifies a motion as one of the library's twelve activities: a small network on statistics of its features."""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import nn

from studies.motion.motiongpt_data import ACTIVITIES, SentenceExample

Array = np.ndarray
STEPS, WIDTH, SEED = 400, 64, 0


@dataclass(frozen=True, kw_only=True)
class MotionClassifier:
    """A trained network with mean and standard deviation of its input."""

    network: nn.Module
    mean: Float[Array, " statistic"]
    std: Float[Array, " statistic"]

    def ranks(self, motions: list[Array]) -> Int[Array, "motion activity"]:
        """Indices into ACTIVITIES for each motion (frame, 263), the most likely first."""
        seen = (np.stack([statistics_of(motion) for motion in motions]) - self.mean) / self.std
        with torch.inference_mode():
            return self.network(torch.from_numpy(seen).float()).numpy().argsort(axis=1)[:, ::-1].copy()


def statistics_of(features: Float[Array, "frame 263"]) -> Float[Array, " statistic"]:
    """Mean, standard deviation, minimum and maximum of each feature over time."""
    parts = (features.mean(axis=0), features.std(axis=0), features.min(axis=0), features.max(axis=0))
    return np.concatenate(parts)


def train_classifier(examples: list[SentenceExample]) -> MotionClassifier:
    """Trained on library motions; half of its input is dropped at random in each step, so that it does not depend on
    a few features."""
    seen = np.stack([statistics_of(example.features) for example in examples])
    mean, std = seen.mean(axis=0), seen.std(axis=0) + 1e-3
    inputs = torch.from_numpy((seen - mean) / std).float()
    truth = torch.tensor([ACTIVITIES.index(example.activity) for example in examples])
    torch.manual_seed(SEED)
    network = nn.Sequential(
        nn.Dropout(0.5), nn.Linear(inputs.shape[1], WIDTH), nn.ReLU(), nn.Linear(WIDTH, len(ACTIVITIES))
    )
    optimiser = torch.optim.AdamW(network.parameters(), lr=2e-3, weight_decay=1e-2)
    for _ in range(STEPS):
        loss = nn.functional.cross_entropy(network(inputs), truth)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return MotionClassifier(network=network.eval(), mean=mean, std=std)
