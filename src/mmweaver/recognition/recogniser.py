"""A trained recogniser, stored as a folder of safe files, that labels windows of point clouds.

Reference: docs/recognise.md. `load_recogniser(folder)` reads one; `Recogniser.recognise` labels a recording,
`LiveRecogniser` frames as they arrive.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.recognition.background_mask import NO_CELLS
from mmweaver.recognition.guards import GUARDS, WindowFilter
from mmweaver.recognition.point_recordings import PointRecording, windows_of
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.recording_checks import contradictions
from mmweaver.recognition.spatiotemporal_features import spatiotemporal_features
from mmweaver.recognition.task_file import RecordedColumns, RecordingSettings
from mmweaver.recognition.tree_ensemble import Features, TreeEnsemble, read_trees, write_trees
from mmweaver.recognition.window_features import UNPREDICTABLE, Row, body_features, window_features

META_FILE, TREES_FILE, FEATURES_FILE = "meta.json", "trees.npz", "features.npz"
MODEL_FILES = (META_FILE, TREES_FILE, FEATURES_FILE)
KIND, VERSION = "mmweaver recogniser", 1
QUANTILES = np.concatenate([[0.005, 0.02], np.linspace(0.05, 0.95, 19), [0.98, 0.995]])
FEWEST = 20  # minimum number of known values for a distribution

Quantiles = Float[np.ndarray, "quantile feature"]


@dataclass(frozen=True, kw_only=True)
class Recognition:
    """The label of one window."""

    first_frame: int
    num_frames: int
    label: str
    votes: dict[str, float]  # by label, with a sum of 1
    is_outside: bool  # the window is out of distribution: do not trust the label

    def as_json(self) -> str:
        """The record as one line of JSON."""
        votes = {name: round(value, 3) for name, value in self.votes.items()}
        return json.dumps({**asdict(self), "votes": votes}, ensure_ascii=False)


@dataclass(frozen=True, kw_only=True, eq=False)
class Recogniser:
    """Trees over window features, and the distribution of their training data."""

    settings: RecordingSettings
    names: tuple[str, ...]  # of the features
    trees: TreeEnsemble
    generated: Quantiles  # of generated windows
    outside_above: float  # maximum share of features beyond the outer quantiles within the distribution
    meta: dict[str, Any]
    points: WindowFilter = field(default_factory=WindowFilter)  # filter of a window's points

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels in the order of the votes."""
        return self.settings.labels

    def without(self, guards: frozenset[str]) -> "Recogniser":
        """The recogniser with further guards switched off (`guards.GUARDS`)."""
        return replace(self, points=self.points.without(guards))

    def contradictions(self, recordings: Sequence[PointRecording]) -> list[str]:
        """Contradictions between recordings and the task, one line each.

        None for models that do not know their radar.
        """
        return [] if self.points.radar is None else contradictions(recordings, self.points.radar)

    def features(self, windows: Sequence[PointRecording]) -> Features:
        """Features of windows.

        Args:
            windows: Points of each window.

        Returns:
            Features (window, feature), float32, nan where unknown.
        """
        return recognition_features([self.points(window) for window in windows], self.names)

    def votes(self, features: Features) -> Float[np.ndarray, "window label"]:
        """Votes of the trees.

        Args:
            features: As given by `features`.

        Returns:
            Share of each label (window, label).
        """
        return self.trees.probabilities(features)

    def is_outside(self, features: Features) -> Bool[np.ndarray, " window"]:
        """Mask (window,) of windows that are out of the distribution of generated ones."""
        return outside_share(features, self.generated) > self.outside_above

    def recognise(self, recording: PointRecording) -> list[Recognition]:
        """Labels a recording.

        Args:
            recording: Points of all frames.

        Returns:
            One record per window of `windows_of`.
        """
        return self.recognise_windows(windows_of(recording, self.settings))

    def recognise_windows(self, windows: Sequence[PointRecording]) -> list[Recognition]:
        """Labels windows."""
        if not windows:
            return []
        features = self.features(windows)
        votes, outside = self.votes(features), self.is_outside(features)
        return [
            Recognition(
                first_frame=window.first_frame,
                num_frames=window.num_frames,
                label=self.labels[int(np.argmax(vote))],
                votes=dict(zip(self.labels, map(float, vote), strict=True)),
                is_outside=bool(out),
            )
            for window, vote, out in zip(windows, votes, outside, strict=True)
        ]

    def recognise_cloud(self, cloud: PointCloud, num_frames: int) -> list[Recognition]:
        """Labels a point cloud, such as a generated one.

        Args:
            cloud: The points.
            num_frames: Number of frames, from 0.

        Returns:
            One record per window of `windows_of`.
        """
        return self.recognise(
            PointRecording(name="", cloud=cloud, num_frames=num_frames, frame_rate_hz=self.settings.frame_rate_hz)
        )


def quantiles_of(features: Features) -> Quantiles:
    """Quantiles (quantile, feature) of the known values of each feature; nan where there are too few."""
    columns = [column[np.isfinite(column)] for column in features.T]
    none = np.full(len(QUANTILES), np.nan)
    return np.stack(
        [np.quantile(column, QUANTILES) if len(column) >= FEWEST else none for column in columns], axis=1
    ).astype(np.float32)


def outside_share(features: Features, generated: Quantiles) -> Float[np.ndarray, " window"]:
    """Share of each window's known features beyond the outer quantiles of generated windows.

    Args:
        features: Features (window, feature).
        generated: Quantiles (quantile, feature) of generated windows.
    """
    known = np.isfinite(features) & np.isfinite(generated[0])
    with np.errstate(invalid="ignore"):
        out = (features < generated[0]) | (features > generated[-1])
    return (out & known).sum(axis=1) / np.maximum(known.sum(axis=1), 1)


def recognition_features(windows: Sequence[PointRecording], names: tuple[str, ...] | None = None) -> Features:
    """Features of windows.

    Args:
        windows: Points of each window.
        names: Names of the features; by default all of `window_row`.

    Returns:
        Features (window, feature), float32, nan where unknown.
    """
    rows = [window_row(window) for window in windows]
    chosen = names or tuple(rows[0])
    return np.array([[row[name] for name in chosen] for row in rows], np.float32).reshape(len(rows), len(chosen))


def window_row(window: PointRecording) -> Row:
    """All features of a window, by name, that a simulation can predict.

    Features of height and unevenness depend on body and beam, and are excluded.
    """
    row = {**window_features(window), **body_features(window)}
    kept = {name: value for name, value in row.items() if not UNPREDICTABLE & set(name.split("_"))}
    return kept | spatiotemporal_features(window)


# files --------------------------------------------------------------------------------------------------------------
def save_recogniser(folder: Path, model: Recogniser) -> None:
    """Writes a recogniser. meta.json is written last, so a folder that contains it is complete.

    Args:
        folder: The folder, which must exist.
        model: The recogniser.
    """
    write_trees(folder / TREES_FILE, model.trees)
    with atomic_file(folder / FEATURES_FILE) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(
            stream,
            names=np.array(model.names),
            generated=model.generated,
            busy=model.points.background,
            persistent=model.points.persistent,
        )
    settings = asdict(model.settings) | {
        "columns": None if model.settings.columns is None else list(model.settings.columns.names)
    }
    values = {
        "kind": KIND,
        "version": VERSION,
        "recordings": settings,
        "outside_above": model.outside_above,
        "guards_off": sorted(model.points.off),
        **model.meta,
    }
    with atomic_file(folder / META_FILE) as temporary:
        temporary.write_text(json.dumps(values, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def load_recogniser(folder: Path | str) -> Recogniser:
    """Loads a folder of `mmweaver recognise train`.

    Raises:
        InputError: If it is not a recogniser, or damaged.
    """
    folder = Path(folder)
    check_exists(folder, "a folder of mmweaver recognise train")
    if not (folder / META_FILE).is_file():
        raise InputError(f"{folder} holds no recogniser; mmweaver recognise train TASK.toml --out {folder} makes one")
    meta = read_json(folder / META_FILE)
    if not isinstance(meta, dict) or meta.get("kind") != KIND or meta.get("version") != VERSION:
        raise InputError(f"{folder / META_FILE} describes no recogniser of this version; train it again")
    settings = _settings(meta, folder / META_FILE)
    held = read_npz(folder / FEATURES_FILE)
    names = held.texts("names")
    generated = held.numbers("generated", (len(QUANTILES), len(names)), nan=True)
    if "recorded" in held:
        raise InputError(f"{folder} was trained with matching of features, which is gone; train the recogniser again")
    background, persistent = (
        held.numbers(name, ("cell", 2), kinds="iu", low=-1000, high=1000) if name in held else NO_CELLS
        for name in ("busy", "persistent")
    )
    outside_above = meta.get("outside_above")
    if not isinstance(outside_above, float):
        raise InputError(f"{folder / META_FILE} lacks outside_above; train the recogniser again")
    known = {"kind", "version", "recordings", "outside_above", "guards_off"}
    return Recogniser(
        settings=settings,
        names=names,
        trees=read_trees(folder / TREES_FILE, len(names), len(settings.labels)),
        generated=generated,
        outside_above=outside_above,
        points=WindowFilter(
            background=background,
            persistent=persistent,
            radar=Quantisation.read(meta.get("radar_facts")),
            off=frozenset(GUARDS) & frozenset(map(str, meta.get("guards_off") or ())),
        ),
        meta={name: value for name, value in meta.items() if name not in known},
    )


def _settings(meta: dict[str, Any], file: Path) -> RecordingSettings:
    try:
        found = meta["recordings"]
        columns, gap = found["columns"], found["gap_frames"]
        settings = RecordingSettings(
            labels=tuple(found["labels"]),
            window_s=float(found["window_s"]),
            frame_rate_hz=float(found["frame_rate_hz"]),
            gap_frames=None if gap is None else int(gap),
            empty_label=found.get("empty_label"),  # models of before 0.3 do not have it
        )
        labels = settings.labels
        if not labels or not all(isinstance(one, str) for one in labels) or settings.empty_label not in (None, *labels):
            raise TypeError
    except (TypeError, KeyError, ValueError, AttributeError):
        raise InputError(f"{file} does not say how recordings are read; train the recogniser again") from None
    return settings if columns is None else replace(settings, columns=RecordedColumns.of(columns, str(file)))
