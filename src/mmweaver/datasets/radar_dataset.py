"""PyTorch data set over a labelled set or a data set of rooms; features are computed on the fly or cached in memory."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.utils.data import Dataset

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.datasets.activity_store import SPLIT_KEYS, SPLITS
from mmweaver.datasets.room_sequences import LabelledData, read_labelled
from mmweaver.signal.features import (
    dynamic_range_angle,
    micro_doppler_db,
    point_table,
    range_azimuth_db,
    range_doppler_db,
    range_elevation_db,
)

OF_CUBE: dict[str, Callable[[RadarCube], np.ndarray]] = {
    "iq": lambda cube: cube.values,
    "rd": range_doppler_db,
    "ra": range_azimuth_db,
    "re": range_elevation_db,
    "drai": dynamic_range_angle,
    "micro_doppler": micro_doppler_db,
}
FEATURES = (*OF_CUBE, "points", "pose", "label")


class RadarDataset(Dataset[dict[str, Any]]):
    """Sequences of a data set as dicts of tensors, for torch's DataLoader.

    The order is that of the set; an item is identical in every worker.

    Args:
        path: A labelled set (`mmweaver dataset --activities`, `mmweaver generate --texts --store`) or a data set of
            rooms (`mmweaver dataset --layouts`).
        features: Any of "iq" (complex64: frame, range, doppler, antenna), "rd" (dB: frame, range, doppler), "ra" (dB:
            frame, range, azimuth), "re" (dB: frame, range, elevation), "drai" (linear: frame, 32, 32), "micro_doppler"
            (dB: window, doppler), "points" ((point, 6): frame, x, y, z, velocity, SNR), "pose" ((frame, 22, 3) metres)
            and "label" (int). Default: "rd" and "label".
        split: "train", "validation", "test", another split of a data set of rooms, or None for all. Default: all.
        by: Property that is held out in a labelled set: "subject", "place", "room" or "sentence". Default: as built.
        cached: Whether computed features are kept in memory. Default: False.

    Raises:
        InputError: If a name is unknown, or the set is incomplete or damaged.
    """

    def __init__(
        self,
        path: str | Path | LabelledData,
        features: Sequence[str] = ("rd", "label"),
        *,
        split: str | None = None,
        by: str | None = None,
        cached: bool = False,
    ):
        unknown = [name for name in features if name not in FEATURES]
        if unknown or not features:
            raise InputError(f"unknown features {', '.join(unknown) or '(none)'}; known: {', '.join(FEATURES)}")
        if by is not None and by not in SPLIT_KEYS:
            raise InputError(f"unknown key {by!r}; splits are by {', '.join(SPLIT_KEYS)}")
        self.set = read_labelled(Path(path)) if isinstance(path, str | Path) else path
        self.features = tuple(features)
        column = "split" if by is None else f"split_{by}"
        if column not in self.set.columns:
            raise InputError("a data set of rooms has one split, by room; leave out `by`")
        of_split = self.set.columns[column]
        known = sorted({*SPLITS, *map(str, of_split)})
        if split is not None and split not in known:
            raise InputError(f"unknown split {split!r}; known: {', '.join(known)}, or None for all")
        chosen = np.ones(len(self.set), bool) if split is None else of_split == split
        self.indices = np.flatnonzero(chosen)
        self._cache: dict[int, dict[str, Any]] | None = {} if cached else None

    @property
    def label_names(self) -> tuple[str, ...]:
        """Names of the labels by number."""
        return self.set.label_names

    def __len__(self) -> int:
        return len(self.indices)

    def __getitem__(self, index: int) -> dict[str, Any]:
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        own = int(self.indices[index])
        if self._cache is None:
            return self._item(own)
        if own not in self._cache:
            self._cache[own] = self._item(own)
        return self._cache[own]

    def _item(self, own: int) -> dict[str, Any]:
        data, item = self.set, dict[str, Any]()
        cube = data.cube(own) if OF_CUBE.keys() & set(self.features) else None
        for name in self.features:
            if name == "label":
                item[name] = int(data.columns["label"][own])
                continue
            if cube is not None and name in OF_CUBE:
                values = OF_CUBE[name](cube)
            else:
                values = data.joints_m[own] if name == "pose" else frame_and_points(data.cloud(own))
            item[name] = torch.from_numpy(np.ascontiguousarray(values))
        return item


def frame_and_points(points: PointCloud) -> np.ndarray:
    """Converts a point cloud to rows.

    Args:
        points: The cloud.

    Returns:
        Float32 (point, 6): frame, x, y, z in metres, radial velocity in m/s, SNR in dB.
    """
    return np.concatenate([points.frame[:, None].astype(np.float32), point_table(points)], axis=1)


def collate(items: Sequence[dict[str, Any]]) -> dict[str, torch.Tensor]:
    """Collates items to a batch, for DataLoader(collate_fn=...).

    Args:
        items: Items of a `RadarDataset`.

    Returns:
        Stacked tensors; point clouds are zero-padded, with `points_mask` (item, point).
    """
    batch: dict[str, torch.Tensor] = {}
    for name in items[0]:
        values = [item[name] for item in items]
        if name == "points":
            most = max(len(value) for value in values)
            batch[name] = torch.stack(
                [torch.nn.functional.pad(value, (0, 0, 0, most - len(value))) for value in values]
            )
            batch["points_mask"] = torch.stack([torch.arange(most) < len(value) for value in values])
        elif name == "label":
            batch[name] = torch.tensor(values)
        else:
            batch[name] = torch.stack(values)
    return batch
