"""Comparison of two signals: features with spread, maps on common axes, point clouds, and what distinguishes them.

    compare("recording/", "simulated/")                paths of any kind, or records
    compare_signals([signal], [other])                 cubes with points and meta in memory

Reference: docs/compare.md.
"""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud

# imported to register their features
from mmweaver.evaluation import board_features, cloud_features, person_features, room_features  # noqa: F401
from mmweaver.evaluation.compared_sides import CommonAxes, common_axes, common_window_m, maps_of, shown_m, signals_of
from mmweaver.evaluation.finding import FEATURES, Difference, Feature, FrameValues, Spread, difference_of, spread_of
from mmweaver.evaluation.signal_evidence import MIN_UNITS, CannotSeeError, ComparedSignal, SignalEvidence
from mmweaver.io.result_folder import plain
from mmweaver.recordings.read_recording import RawReading

MIN_RECORDINGS = 4  # with fewer, frames are the units of the spread
CLEAR_EFFECT = 1.0
SCHEMA_VERSION = 1


@dataclass(frozen=True, kw_only=True)
class SideValue:
    """A feature of one side.

    Attributes:
        spread: Median and spread; None if the feature cannot be measured.
        units: Units of the spread: frames, quarters of frames, or recordings.
        at_most: Whether the values are upper limits.
        cannot_see: Reason if it cannot be measured.
        values: One value per unit.
    """

    spread: Spread | None = None
    units: str = ""
    at_most: bool = False
    cannot_see: str | None = None
    values: np.ndarray | None = None

    def text(self, unit: str) -> str:
        """Formats the median with its interval.

        Args:
            unit: Unit of the feature.

        Returns:
            Text such as "-3.2 (-3.5 to -2.9) dB", or the reason why it cannot be measured.
        """
        if self.spread is None:
            return f"cannot be seen, {self.cannot_see}"
        low_high = self.spread.interval_95
        span = "" if low_high is None else f" ({low_high[0]:.3g} to {low_high[1]:.3g})"
        return f"{'at most ' if self.at_most else ''}{self.spread.median:.3g}{span} {unit}"


@dataclass(frozen=True, kw_only=True)
class FeatureComparison:
    """One feature of both sides; `difference` is None if it cannot be measured on one of them."""

    feature: Feature
    a: SideValue
    b: SideValue
    difference: Difference | None

    @property
    def gives_away(self) -> bool:
        """Whether this feature distinguishes B from A: the entire interval of the effect size lies beyond 1.

        An upper limit above the other side's value is no evidence.
        """
        span = None if self.difference is None else self.difference.effect_interval_95
        if span is None:
            return False
        return (span[0] > CLEAR_EFFECT and not self.b.at_most) or (span[1] < -CLEAR_EFFECT and not self.a.at_most)

    def text(self) -> str:
        """One row of the table for a terminal."""
        if self.difference is None:
            return f"  {self.feature.title}: A {self.a.text(self.feature.unit)}; B {self.b.text(self.feature.unit)}"
        span, alike = self.difference.effect_interval_95, self.difference.separable
        effect = f"{self.difference.effect_size:+.1f}"
        effect += "" if span is None else f" ({span[0]:+.1f} to {span[1]:+.1f})"
        auc = "" if alike is None else f"AUC {100 * alike:.0f} %"
        a, b = (side.text(self.feature.unit) for side in (self.a, self.b))
        mark = "*" if self.gives_away else " "
        return f"{mark} {self.feature.title:42s} {effect:24s} A {a:32s} B {b:32s} {auc}".rstrip()

    def to_values(self) -> dict[str, Any]:
        """Entry of comparison.json."""
        sides = {
            key: {"value": side.spread, "of": side.units, "at_most": side.at_most, "cannot_see": side.cannot_see}
            for key, side in (("a", self.a), ("b", self.b))
        }
        about = {key: getattr(self.feature, key) for key in ("title", "unit", "definition", "tolerance")}
        return {**about, **sides, "difference": self.difference, "gives_b_away": self.gives_away}


@dataclass(frozen=True, kw_only=True)
class SideFacts:
    """Description of the signals of one side."""

    name: str
    recordings: tuple[str, ...]
    radar: str
    frames: int
    antennas: int
    range_m: tuple[float, float]
    has_samples: bool

    def text(self) -> str:
        """One line of text."""
        more = f", {len(self.recordings)} recordings" if len(self.recordings) > 1 else ""
        return (
            f"{self.name}: {self.radar}, {self.frames} frames{more}, {self.antennas} antennas,"
            f" {self.range_m[0]:.2f} to {self.range_m[1]:.2f} m, {'samples' if self.has_samples else 'cube'}"
        )


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Result of `compare`.

    Attributes:
        sides: Description of A and B.
        features: All features.
        axes: Common axes of the maps.
        maps: Power maps of the first recording of each side, see `common_axes.maps_of`.
        clouds: Point clouds of the first recording of each side.
        notes: Sentences on the comparison.
    """

    sides: tuple[SideFacts, SideFacts]
    features: tuple[FeatureComparison, ...]
    axes: CommonAxes
    maps: tuple[dict[str, np.ndarray], dict[str, np.ndarray]]
    clouds: tuple[PointCloud, PointCloud]
    notes: tuple[str, ...]

    @property
    def ranked(self) -> list[FeatureComparison]:
        """Features measured on both sides, largest effect size first; those without an interval come last."""
        return sorted((one for one in self.features if one.difference is not None), key=_rank)

    def to_values(self) -> dict[str, Any]:
        """Content of comparison.json."""
        velocity = self.axes.radial_velocity_mps
        common = {
            "range_m": [self.axes.range_m[0], self.axes.range_m[-1]],
            "reference": self.axes.reference,
            "max_velocity_mps": None if velocity is None else velocity[-1],
        }
        return plain(
            {
                "schema_version": SCHEMA_VERSION,
                "made_by": "mmweaver compare",
                "version": __version__,
                "a": self.sides[0],
                "b": self.sides[1],
                "common": common,
                "features": {one.feature.name: one.to_values() for one in self.features},
                "ranked": [one.feature.name for one in self.ranked],
                "gives_b_away": [one.feature.name for one in self.ranked if one.gives_away],
                "notes": self.notes,
            }
        )

    def save(self, out: str | Path, *, overwrite: bool = False) -> list[Path]:
        """Writes comparison.png, comparison.json and comparison.html.

        Args:
            out: The folder.
            overwrite: Whether these files may exist. Default: False.

        Returns:
            Paths of the files.

        Raises:
            InputError: If a file exists without `overwrite`, or cannot be written.
        """
        from mmweaver.evaluation.comparison_page import write_comparison

        return write_comparison(self, Path(out), overwrite=overwrite)

    def text(self) -> str:
        """Formats the comparison as a table for a terminal."""
        hidden = [one for one in self.features if one.difference is None]
        lines = [f"A  {self.sides[0].text()}", f"B  {self.sides[1].text()}", "", *(one.text() for one in self.ranked)]
        lines += ["", *(one.text() for one in hidden), "", f"  decibels: {self.axes.reference}"]
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)])


def compare(
    a: Any,
    b: Any,
    *,
    radar: str | Path | RadarConfig | None = None,
    radar_b: str | Path | RadarConfig | None = None,
    range_m: tuple[float, float] | None = None,
    **samples: Any,
) -> Comparison:
    """Compares two signals, or two folders of signals.

    Args:
        a: A recording, a result folder, a .mmw file, a stream folder, a folder of any of these; or a RadarCube, an
            AdcCube, a result of `Weaver.generate`, `process_recording` or `read_recording`, or a list of any of these.
        b: The same, to be compared with `a`.
        radar: Radar of raw samples without their own: name of a preset, file, or RadarConfig.
        radar_b: Radar of `b`. Default: `radar`.
        range_m: Ranges (near, far) in metres to compare. Default: all that both cover.
        **samples: `layout`, `axes`, `iq_order` and `tx_order` of raw samples, see `read_recording`.

    Returns:
        The comparison, with `ranked` features, `text()` and `save()`.

    Raises:
        InputError: If a signal cannot be read, is zero everywhere, or there are no common ranges.
    """
    names = tuple(str(one) if isinstance(one, str | Path) else letter for one, letter in ((a, "A"), (b, "B")))
    radars = radar, radar if radar_b is None else radar_b
    sides = [
        signals_of(one, RawReading(radar=own, **samples), letter)
        for one, own, letter in zip((a, b), radars, "AB", strict=True)
    ]
    return compare_signals(sides[0], sides[1], names=(names[0], names[1]), range_m=range_m)


def compare_signals(
    a: Sequence[ComparedSignal],
    b: Sequence[ComparedSignal],
    *,
    names: tuple[str, str] = ("A", "B"),
    range_m: tuple[float, float] | None = None,
) -> Comparison:
    """Compares signals in memory, one or more per side.

    Args:
        a: Signals of A.
        b: Signals of B.
        names: Names of the sides. Default: A and B.
        range_m: Ranges (near, far) in metres to compare. Default: all that both cover.

    Returns:
        The comparison.

    Raises:
        InputError: If a signal is zero everywhere, or there are no common ranges.
    """
    sides, notes = _unify_detectors(a, b)
    labels = [name if len(side) == 1 else one.name for name, side in zip(names, sides, strict=True) for one in side]
    every = [*sides[0], *sides[1]]
    for label, one in zip(labels, every, strict=True):
        if not one.cube.values.any():
            raise InputError(f"{label} holds nothing but zeros; give a recording with a signal")
    window_m = common_window_m(labels, [shown_m(one) for one in every], range_m)
    points_m = common_window_m(labels, [one.cube.grid.range_m for one in every], range_m)
    first = [SignalEvidence(side[0], window_m, points_m) for side in sides]
    measured = [
        # keep intermediate results of the first recording only: folders contain many
        [measure_all(kept), *(measure_all(SignalEvidence(one, window_m, points_m)) for one in side[1:])]
        for kept, side in zip(first, sides, strict=True)
    ]
    axes = common_axes(first[0], first[1])
    return Comparison(
        sides=(_facts(names[0], sides[0]), _facts(names[1], sides[1])),
        features=tuple(_compared(feature, measured[0], measured[1]) for feature in FEATURES),
        axes=axes,
        maps=(maps_of(first[0], axes), maps_of(first[1], axes)),
        clouds=(first[0].points, first[1].points),
        notes=(*notes, *_notes(sides)),
    )


def measure_all(evidence: SignalEvidence) -> dict[str, SideValue]:
    """Measures all features of one signal.

    Args:
        evidence: The signal.

    Returns:
        Values by name of the feature.
    """
    parts = evidence.quarters() if len(evidence.cube.values) < MIN_UNITS else None
    return {feature.name: measure(feature, evidence, parts) for feature in FEATURES}


def measure(feature: Feature, evidence: SignalEvidence, parts: SignalEvidence | None = None) -> SideValue:
    """Measures one feature of a signal, with one value per frame.

    Args:
        feature: The feature.
        evidence: The signal.
        parts: The signal with its few frames divided into quarters, used if the feature can be measured on them.
            Default: none.

    Returns:
        Median and spread, or the reason why it cannot be measured.
    """
    try:
        found, units = _seen(feature, evidence), "frames"
    except CannotSeeError as reason:
        return SideValue(cannot_see=str(reason))
    if parts is not None and not feature.whole_frames:
        with contextlib.suppress(CannotSeeError):
            found, units = _seen(feature, parts), "quarters of frames"
    values = found.values[np.isfinite(found.values)]
    return SideValue(spread=spread_of(values, in_order=True), units=units, at_most=found.at_most, values=values)


def _seen(feature: Feature, evidence: SignalEvidence) -> FrameValues:
    with np.errstate(divide="ignore", invalid="ignore"):  # lost frames are zero
        found = feature.measure(evidence)
    if len(found.values) == len(evidence.is_lost):
        found = replace(found, values=np.where(evidence.is_lost, np.nan, found.values))
    if not np.isfinite(found.values).any():
        raise CannotSeeError("no frame shows it")
    return found


def _compared(feature: Feature, a: list[dict[str, SideValue]], b: list[dict[str, SideValue]]) -> FeatureComparison:
    by_recording = min(len(a), len(b)) >= MIN_RECORDINGS
    own, other = (_pooled([one[feature.name] for one in side], by_recording) for side in (a, b))
    difference = None
    if own.values is not None and other.values is not None:
        difference = difference_of(own.values, other.values, feature.tolerance, in_order=not by_recording)
    return FeatureComparison(feature=feature, a=own, b=other, difference=difference)


def _pooled(each: list[SideValue], by_recording: bool) -> SideValue:
    """Pools several recordings: their medians, or all frames if there are few recordings."""
    seen = [(one, one.spread, one.values) for one in each if one.values is not None and one.spread is not None]
    if len(each) == 1 or not seen:
        return each[0]
    parts = [np.array([spread.median]) if by_recording else values for _, spread, values in seen]
    values = np.concatenate(parts)
    return SideValue(
        spread=spread_of(values, in_order=not by_recording),
        units="recordings" if by_recording else seen[0][0].units,
        at_most=all(one.at_most for one, _, _ in seen),
        values=values,
    )


def _unify_detectors(
    a: Sequence[ComparedSignal], b: Sequence[ComparedSignal]
) -> tuple[list[list[ComparedSignal]], list[str]]:
    """Keeps stored points only if all signals used the same detector; otherwise CFAR for all."""
    kinds = {one.meta.get("points") if one.points is not None else None for one in (*a, *b)}
    if len(kinds) == 1 and None not in kinds:
        return [list(a), list(b)], [f"points as stored, by {kinds.pop()}"]
    return [[replace(one, points=None) for one in side] for side in (a, b)], ["points by CFAR on both cubes"]


def _notes(sides: list[list[ComparedSignal]]) -> list[str]:
    notes = []
    a, b = (side[0].cube.config for side in sides)
    if a.num_antennas != b.num_antennas:
        notes.append(
            f"arrays differ, {a.num_antennas} and {b.num_antennas} antennas: the best plane wave, antennas and azimuths"
            " with them"
        )
    steps = [(one.range_resolution_m, one.velocity_resolution_mps) for one in (a, b)]
    if not np.allclose(*steps, rtol=0.2):
        notes.append("resolutions differ: peaks over medians and sparsity depend on them")
    if any(len(side) > 1 for side in sides):
        notes.append("pictures are of the first recording of each side")
    return notes


def _facts(name: str, side: list[ComparedSignal]) -> SideFacts:
    config, range_m = side[0].cube.config, shown_m(side[0])
    return SideFacts(
        name=name,
        recordings=tuple(one.name for one in side),
        radar=config.name,
        frames=sum(len(one.cube.values) for one in side),
        antennas=config.num_antennas,
        range_m=(float(range_m[0]), float(range_m[-1])),
        has_samples=side[0].adc is not None,
    )


def _rank(one: FeatureComparison) -> tuple[bool, float]:
    assert one.difference is not None
    return one.difference.effect_interval_95 is None, -abs(one.difference.effect_size)
