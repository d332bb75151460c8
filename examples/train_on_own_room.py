"""A labelled set of the bundled room, and a small network that tells three activities of people it has not seen.

Usage: `python examples/train_on_own_room.py [FOLDER] [SEQUENCES_PER_LABEL]`
"""

import sys
from pathlib import Path

import torch
from torch.utils.data import DataLoader

from mmweaver import Weaver
from mmweaver.datasets.build_set import SetBuilder, SetOptions
from mmweaver.datasets.radar_dataset import RadarDataset, collate

ACTIVITIES = {
    "waving": ("a person waves with the left hand", "a person waves with the right hand"),
    "walking": ("a person walks around",),
    "squatting": ("a person squats",),
}
EPOCHS = 40


def main(out: Path, each: int) -> float:
    """Makes the set, trains, and returns the accuracy on held-out people."""
    weaver = Weaver()
    builder = SetBuilder(
        out, ACTIVITIES, [weaver.sample_room()], weaver, SetOptions(each=each),
        command="python examples/train_on_own_room.py", activities_text="",
    )  # fmt: skip
    print(builder.make()["verdict"])
    train, test = (
        RadarDataset(out, ["micro_doppler", "label"], split=split, cached=True) for split in ("train", "test")
    )
    torch.manual_seed(0)
    network = torch.nn.Sequential(
        torch.nn.Conv2d(1, 16, 3, padding=1), torch.nn.ReLU(), torch.nn.MaxPool2d(2),
        torch.nn.Conv2d(16, 32, 3, padding=1), torch.nn.ReLU(), torch.nn.AdaptiveAvgPool2d((1, 8)),
        torch.nn.Flatten(), torch.nn.Linear(256, len(train.label_names)),
    )  # fmt: skip
    optimizer = torch.optim.Adam(network.parameters(), 3e-3)
    loader = DataLoader(train, batch_size=16, shuffle=True, collate_fn=collate)
    for _ in range(EPOCHS):
        for batch in loader:
            loss = torch.nn.functional.cross_entropy(network(_input(batch)), batch["label"])
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
    network.eval()
    with torch.no_grad():
        batch = collate([test[index] for index in range(len(test))])
        accuracy = float((network(_input(batch)).argmax(1) == batch["label"]).float().mean())
    print(f"accuracy on {len(test)} sequences of people not seen: {accuracy:.2f} (chance {1 / len(ACTIVITIES):.2f})")
    return accuracy


def _input(batch: dict[str, torch.Tensor]) -> torch.Tensor:
    """Micro-Doppler as one channel, less its mean."""
    power = batch["micro_doppler"]
    return ((power - power.mean(dim=(1, 2), keepdim=True)) / 10)[:, None]


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "own_room"), int(sys.argv[2]) if len(sys.argv) > 2 else 30)
