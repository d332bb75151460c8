"""Labelled log maps of a data set of rooms or of one's own, for training and evaluating the activity network."""

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.datasets.activity_store import ActivitySet
from mmweaver.datasets.room_sequences import LabelledData, plan_of, read_labelled
from mmweaver.models.log_maps import LogMaps

GAIN_SPREAD_DB, SHIFT_BINS, SHIFT_FRAMES = 2.0, 6, 3  # strength of the augmentation


@dataclass(frozen=True, kw_only=True)
class ActivityExamples:
    """Sequences as log maps in half precision, about 0.25 MB each, with activity, room and person."""

    doppler: Tensor  # (sequence, frame, 1, range, doppler)
    angle: Tensor  # (sequence, frame, 2, range, azimuth)
    label: Tensor  # (sequence,) index into label_names
    label_names: tuple[str, ...]
    room: tuple[str, ...]
    person: tuple[int, ...]
    config: RadarConfig

    def __len__(self) -> int:
        return len(self.label)


def compute_log_maps(cubes: Iterable[RadarCube], config: RadarConfig) -> tuple[Tensor, Tensor]:
    """Log maps of cubes in sqrt(mW), in half precision: range-Doppler and range-angle, (sequence, frame, ...)."""
    maps, doppler, angle = LogMaps(config), [], []
    with torch.no_grad():
        for cube in cubes:
            one, other = maps(torch.from_numpy(cube.values))
            doppler.append(one.half())
            angle.append(other.half())
    return torch.stack(doppler), torch.stack(angle)


def activity_examples(
    folder: Path,
    splits: tuple[str, ...],
    cache: Path | None = None,
    *,
    keep: bool = True,
    device: str = "cpu",
    pick: Callable[[np.ndarray], np.ndarray] | None = None,
) -> ActivityExamples:
    """The sequences of a data set in the given splits, optionally selected by `pick` from their labels.

    Their maps are read from the file `cache` if it has the same sequences, else computed and, with `keep`, saved there;
    signals that are not stored are synthesised on `device`. Raises InputError where there are no sequences.
    """
    data = read_labelled(folder, device=device)
    columns, config = data.columns, data.config
    chosen = np.flatnonzero(np.isin(columns["split"], splits))
    if not len(chosen):
        raise InputError(f"{folder} has no sequences of {' or '.join(splits)}; {_more(data)}")
    if pick is not None:
        chosen = chosen[pick(columns["label"][chosen])]
    mark = _mark(folder, chosen)
    maps = None if cache is None else _read(cache, mark)
    if maps is None:
        maps = compute_log_maps((data.cube(int(index)) for index in chosen), config)
        if cache is not None and keep:
            _write(cache, maps, mark)
    doppler, angle = maps
    return ActivityExamples(
        doppler=doppler,
        angle=angle,
        label=torch.from_numpy(columns["label"][chosen].astype(np.int64)),
        label_names=data.label_names,
        room=tuple(map(str, columns["room"][chosen])),
        person=tuple(map(int, columns["subject"][chosen])),
        config=config,
    )


def _more(data: LabelledData) -> str:
    """How to make sequences of every split."""
    if isinstance(data, ActivitySet):
        return "each split needs people of its own: make the set with three --subjects or more, or another --split-by"
    return "make more with: mmweaver dataset"


def _mark(folder: Path, chosen: np.ndarray) -> str:
    """Hash of a data set's plan and the chosen sequences."""
    words = [plan_of(folder), *map(str, chosen)]
    return hashlib.sha256("\n".join(words).encode()).hexdigest()


def _read(file: Path, mark: str) -> tuple[Tensor, Tensor] | None:
    """The maps of a file, None where they are of other sequences or damaged."""
    try:
        tensors, header = read_tensors(file)
    except InputError:
        return None
    return (tensors["doppler"], tensors["angle"]) if header.get("mark") == mark else None


def _write(file: Path, maps: tuple[Tensor, Tensor], mark: str) -> None:
    write_tensors(file, {"doppler": maps[0], "angle": maps[1]}, {"mark": mark})


def augmented(doppler: Tensor, angle: Tensor, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
    """Augments maps (sequence, frame, channel, range, other) by random gain and cyclic shifts in time and range."""
    from mmweaver.models.log_maps import SPREAD_DB

    gain = torch.from_numpy(rng.normal(0, GAIN_SPREAD_DB / SPREAD_DB, (len(doppler), 1, 1, 1, 1)).astype(np.float32))
    doppler, angle = doppler.float() + gain, angle.float() + gain
    for one, other in zip(doppler, angle, strict=True):
        steps = int(rng.integers(-SHIFT_FRAMES, SHIFT_FRAMES + 1)), int(rng.integers(-SHIFT_BINS, SHIFT_BINS + 1))
        one.copy_(torch.roll(one, steps, (0, 2)))
        other.copy_(torch.roll(other, steps, (0, 2)))
    return doppler, angle
