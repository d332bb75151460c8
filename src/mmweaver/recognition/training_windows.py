"""What the trees of a recogniser learn from: its options, windows with labels and weights, and the trees on them."""

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.errors import InputError
from mmweaver.recognition.performance import PerformancePrior
from mmweaver.recognition.tree_ensemble import TreeEnsemble, grow_trees
from mmweaver.recognition.window_augmentation import PerformanceVariation
from mmweaver.recognition.window_filter import WindowFilter

SEQUENCES = 40  # people an activity


@dataclass(frozen=True, kw_only=True)
class TrainingOptions:
    """How a recogniser is trained; the same for every task."""

    sequences: int = SEQUENCES
    seed: int = 0
    prior: PerformancePrior = PerformancePrior()  # noqa: RUF009 (frozen)
    copies: int = 4  # varied and disturbed ones of each window
    variation: PerformanceVariation = PerformanceVariation()  # noqa: RUF009 (frozen)
    trees: int = 300
    leaf_size: int = 3
    feature_share: float = 0.15
    self_training: bool = True
    labelled_weight: float = 25.0  # of labelled recordings, relative to what was generated

    def __post_init__(self) -> None:
        if not 2 <= self.sequences <= 100_000:
            raise InputError(f"sequences must be 2 to 100000 of each activity, not {self.sequences}")
        if self.seed < 0:
            raise InputError(f"the seed must be 0 or above, not {self.seed}")


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainingWindows:
    """Features of generated windows and of their disturbed copies; with them, perhaps, of recorded ones."""

    features: Float[np.ndarray, "window feature"]
    label: Int[np.ndarray, " window"]
    person: Int[np.ndarray, " window"]
    is_copy: Bool[np.ndarray, " window"]
    names: tuple[str, ...]
    importance: Float[np.ndarray, " window"] | None = None  # None: all the same
    points: WindowFilter = field(default_factory=WindowFilter)  # which of them count

    @property
    def weights(self) -> Float[np.ndarray, " window"]:
        """Every label weighs the same."""
        own = np.ones(len(self.label)) if self.importance is None else self.importance
        return own / np.bincount(self.label, own)[self.label] * len(self.label)


def with_recorded(
    made: TrainingWindows, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"],
    weight: float,
) -> TrainingWindows:  # fmt: skip
    """The windows and recorded ones, which weigh `weight` times as much in each label."""
    own = np.ones(len(made.label)) if made.importance is None else made.importance
    classes = int(made.label.max()) + 1
    of_made, of_recorded = np.bincount(made.label, own, classes), np.bincount(labels, minlength=classes)
    return replace(
        made, features=np.concatenate([made.features, features]), label=np.concatenate([made.label, labels]),
        person=np.concatenate([made.person, np.full(len(labels), -1)]),
        is_copy=np.concatenate([made.is_copy, np.zeros(len(labels), bool)]),
        importance=np.concatenate([own, weight * of_made[labels] / of_recorded[labels]]),
    )  # fmt: skip


def trees_of(
    made: TrainingWindows, options: TrainingOptions, *, which: np.ndarray | None = None, num_trees: int | None = None
) -> TreeEnsemble:
    """Trees on all windows, or on those of a mask (window,)."""
    chosen = options if num_trees is None else replace(options, trees=num_trees)
    return weighed_trees_of(made, chosen, which=which)[0]


def weighed_trees_of(
    made: TrainingWindows, options: TrainingOptions, *, which: np.ndarray | None = None
) -> tuple[TreeEnsemble, Float[np.ndarray, " feature"]]:
    """Trees, and the importance of each feature to them."""
    which = np.ones(len(made.label), bool) if which is None else which
    return grow_trees(
        made.features[which], made.label[which], made.weights[which], int(made.label.max()) + 1,
        trees=options.trees, leaf_size=options.leaf_size, feature_share=options.feature_share, seed=options.seed,
    )  # fmt: skip
