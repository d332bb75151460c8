"""Training data of a recogniser's trees: windows of generated sequences, with copies, labels and weights."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from mmweaver.recognition.background_mask import NO_CELLS, Cells, background_cells
from mmweaver.recognition.generated_sequences import COLUMNS
from mmweaver.recognition.guards import WindowFilter
from mmweaver.recognition.point_recordings import PointRecording, windows_of
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.recogniser import recognition_features, window_row
from mmweaver.recognition.subject_simulation import PerformancePrior
from mmweaver.recognition.task_file import RecognitionTask
from mmweaver.recognition.tree_ensemble import Features, TreeEnsemble, grow_trees
from mmweaver.recognition.window_augmentation import PerformanceVariation, WindowAugmentation, augmented, varied

SEQUENCES = 40  # people per activity
SNR_CUT_DB = 18.0  # of copies: maximum loss of sensitivity of a board
CROWDED_SHARE = 0.3  # share of copies in a furnished room
OVERLAP = 3  # windows of a generated sequence per window length


@dataclass(frozen=True, kw_only=True)
class TrainingOptions:
    """Training of a recogniser; the same for every task."""

    sequences: int = SEQUENCES
    seed: int = 0
    prior: PerformancePrior = PerformancePrior()  # noqa: RUF009 (frozen)
    copies: int = 4  # augmented copies of each window
    variation: PerformanceVariation = PerformanceVariation()  # noqa: RUF009 (frozen)
    trees: int = 300
    leaf_size: int = 3
    feature_share: float = 0.15
    labelled_weight: float = 25.0  # of labelled recordings, relative to generated ones
    guards_off: tuple[str, ...] = ()  # of `guards.GUARDS`

    def __post_init__(self) -> None:
        if not 2 <= self.sequences <= 100_000:
            raise InputError(f"sequences must be 2 to 100000 of each activity, not {self.sequences}")
        if self.seed < 0:
            raise InputError(f"the seed must be 0 or above, not {self.seed}")


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainingWindows:
    """Features of generated windows and their augmented copies, possibly followed by recorded ones."""

    features: Features
    label: Int[np.ndarray, " window"]
    person: Int[np.ndarray, " window"]
    is_copy: Bool[np.ndarray, " window"]
    names: tuple[str, ...]
    importance: Float[np.ndarray, " window"] | None = None  # None for equal weights
    points: WindowFilter = field(default_factory=WindowFilter)  # filter of their points

    @property
    def own_weights(self) -> Float[np.ndarray, " window"]:
        return np.ones(len(self.label)) if self.importance is None else self.importance

    @property
    def weights(self) -> Float[np.ndarray, " window"]:
        """Weights (window,), normalised so that all labels have the same total."""
        own = self.own_weights
        return own / np.bincount(self.label, own)[self.label] * len(self.label)

    def joined(
        self, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"], weight: float
    ) -> "TrainingWindows":
        """These windows followed by recorded ones.

        Args:
            features: Features (other, feature) of the recorded windows.
            labels: Their labels (other,).
            weight: Their total weight relative to the generated windows, per label.
        """
        classes = int(self.label.max()) + 1
        of_made, of_recorded = (
            np.bincount(self.label, self.own_weights, classes),
            np.bincount(labels, minlength=classes),
        )
        return replace(
            self,
            features=np.concatenate([self.features, features]),
            label=np.concatenate([self.label, labels]),
            person=np.concatenate([self.person, np.full(len(labels), -1)]),
            is_copy=np.concatenate([self.is_copy, np.zeros(len(labels), bool)]),
            importance=np.concatenate([self.own_weights, weight * of_made[labels] / of_recorded[labels]]),
        )

    def trees(self, options: TrainingOptions, which: Bool[np.ndarray, " window"] | None = None) -> TreeEnsemble:
        """Trees grown on all windows, or on a subset.

        Args:
            options: How trees are grown.
            which: Mask (window,) of the subset.
        """
        return self.weighed_trees(options, which)[0]

    def weighed_trees(
        self, options: TrainingOptions, which: Bool[np.ndarray, " window"] | None = None
    ) -> tuple[TreeEnsemble, Float[np.ndarray, " feature"]]:
        """Trees with the importance of each feature.

        Args:
            options: How trees are grown.
            which: Mask (window,) of the windows to use; by default all.

        Returns:
            The trees, and the importance (feature,).
        """
        which = np.ones(len(self.label), bool) if which is None else which
        return grow_trees(
            self.features[which],
            self.label[which],
            self.weights[which],
            int(self.label.max()) + 1,
            trees=options.trees,
            leaf_size=options.leaf_size,
            feature_share=options.feature_share,
            seed=options.seed,
        )


def generated_windows(
    sequences: Sequence[PointRecording],
    task: RecognitionTask,
    options: TrainingOptions,
    background: Sequence[PointRecording] = (),
    persistent: Cells = NO_CELLS,
) -> TrainingWindows:
    """Windows of sequences with their augmented copies, with the recorded background where there is one.

    Args:
        sequences: Generated recordings of the task.
        task: Radar, firmware, and how windows are cut.
        options: Number of copies, their variation, and the seed.
        background: Recordings of the empty room.
        persistent: Cells whose moving points are removed, like those of the background.

    Returns:
        Features of the windows, followed by those of the first copy of each, the second, and so on.

    Raises:
        InputError: If an activity gave no window.
    """
    shows_room, once = not (task.firmware.static_removal or background), task.recordings.has_single_performances
    how = WindowAugmentation(
        cell_m=task.radar.range_resolution_m,
        velocity_step_mps=task.radar.velocity_resolution_mps,
        most_objects=WindowAugmentation().most_objects if shows_room else 0,
        crowded_share=CROWDED_SHARE if shows_room else 0.0,
        reversed_share=0.0,
        reflected_share=0.0,
        snr_cut_db=SNR_CUT_DB,
    )
    step_s, radar = task.recordings.window_s / OVERLAP, Quantisation.of(task)
    pairs = [(one, window) for one in sequences for window in windows_of(one, task.recordings, step_s)]
    found = {window.label for _, window in pairs}
    if missing := [label for label in task.recordings.labels if label not in found]:
        raise InputError(
            f"the radar sees nothing of {missing[0]!r}: no window of it was generated; check radar, mount and sentences"
        )
    windows = [
        _add_background(background, window, stream(options.seed, "behind", number))
        for number, (_, window) in enumerate(pairs)
    ]
    for copy in range(options.copies):
        for number, (sequence, window) in enumerate(pairs):
            rng = stream(options.seed, "disturbed", window.name, number, copy)
            first, frames = window.first_frame, window.num_frames
            another = varied(sequence, first, frames, rng, radar, options.variation, once=once)
            windows.append(_add_background(background, augmented(another, rng, how), rng))
    points = WindowFilter(
        background=background_cells(background), persistent=persistent, radar=radar, off=frozenset(options.guards_off)
    )
    windows = [points(window) for window in windows]
    names = tuple(window_row(windows[0]))
    return TrainingWindows(
        features=recognition_features(windows, names),
        label=np.array([task.recordings.labels.index(window.label) for window in windows]),
        person=np.array([int(window.name.rpartition("_")[2]) for window in windows]),
        is_copy=np.arange(len(windows)) >= len(pairs),
        names=names,
        points=points,
    )


def _add_background(
    background: Sequence[PointRecording], window: PointRecording, rng: np.random.Generator
) -> PointRecording:
    """The window with the points of a part of the recorded empty room."""
    if not background:
        return window
    place = background[int(rng.integers(len(background)))]
    first = int(rng.integers(max(place.num_frames - window.num_frames, 0) + 1))
    behind = place.part(first, window.num_frames).cloud
    both = {name: np.concatenate([getattr(window.cloud, name), getattr(behind, name)]) for name in ("frame", *COLUMNS)}
    return replace(window, cloud=PointCloud(**both).select(np.argsort(both["frame"], kind="stable")))
