"""Accuracy and its baselines."""

import torch

from mmweaver.core.boards import AWR1843
from mmweaver.models.activity_network import ACTIVITY_NAMES, ActivityNetwork
from mmweaver.training.activity_training import ActivityExamples
from studies.network.activity_accuracy import row_of


def test_a_network_that_says_one_thing_scores_that_things_share():
    network = ActivityNetwork(AWR1843)
    linear = network.head.last[1]
    assert isinstance(linear, torch.nn.Linear)
    with torch.no_grad():
        linear.weight.zero_()
        linear.bias.zero_()
        linear.bias[3] = 1.0
    label = torch.tensor([3, 3, 3, 5])
    examples = ActivityExamples(
        doppler=torch.zeros(4, 5, 1, 64, 32).half(), angle=torch.zeros(4, 5, 2, 64, 32).half(), label=label,
        room=("a", "a", "b", "b"), person=(0, 1, 0, 1), config=AWR1843,
        label_names=ACTIVITY_NAMES,
    )  # fmt: skip
    row = row_of(network, examples, "test_room")
    metric = row["metrics"]["accuracy"]
    assert metric["value"] == metric["baseline"]["commonest"] == 0.75
    assert row["confusion"][5][3] == 1
    assert row["num_activities"] == 2
