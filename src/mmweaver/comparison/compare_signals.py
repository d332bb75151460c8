"""Two signals compared: features with their spread, maps on common axes, point clouds, and what tells B from A.

    compare("recording/", "simulated/")                paths of any kind, or records
    compare_signals([signal], [other])                 cubes with points and meta that are in memory

Reference: docs/compare.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.comparison import board_features, cloud_features, person_features, room_features
from mmweaver.comparison.common_axes import CommonAxes, SignalMaps, common_axes, common_window_m, maps_of, shown_m
from mmweaver.comparison.compared_sides import RawReading, signals_of
from mmweaver.comparison.effect_size import Difference, Spread, difference_of, spread_of
from mmweaver.comparison.measured_feature import CannotSeeError, Feature, FrameValues
from mmweaver.comparison.signal_evidence import FEWEST_UNITS, ComparedSignal, SignalEvidence
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud
from mmweaver.core.version import __version__
from mmweaver.formats.result_folder import plain
from mmweaver.metrics.point_clouds import chamfer_m

FEATURES: tuple[Feature, ...] = (
    *person_features.FEATURES, *room_features.FEATURES, *board_features.FEATURES, *cloud_features.FEATURES
)  # fmt: skip
FEWEST_RECORDINGS = 4  # as units of the spread; of fewer their frames are
CLEAR_EFFECT = 1.0
SCHEMA_VERSION = 1


@dataclass(frozen=True, kw_only=True)
class SideValue:
    """A feature of one side; `spread` is None where it cannot be seen, and `cannot_see` says why."""

    spread: Spread | None
    units: str  # frames, quarters of frames, windows or recordings
    at_most: bool = False
    cannot_see: str | None = None
    values: np.ndarray | None = None  # of the units

    def text(self, unit: str) -> str:
        """The median with its interval, in words."""
        if self.spread is None:
            return "cannot be seen"
        low_high = self.spread.interval_95
        span = "" if low_high is None else f" ({low_high[0]:.3g} to {low_high[1]:.3g})"
        return f"{'at most ' if self.at_most else ''}{self.spread.median:.3g}{span} {unit}"


@dataclass(frozen=True, kw_only=True)
class FeatureComparison:
    """One feature of both sides; `difference` is None where one of them does not show it."""

    feature: Feature
    a: SideValue
    b: SideValue
    difference: Difference | None

    @property
    def gives_away(self) -> bool:
        """Whether the whole interval of the effect size lies beyond 1: B can be distinguished from A by this feature.

        An upper limit above the other side's value tells nothing.
        """
        span = None if self.difference is None else self.difference.effect_interval_95
        if span is None:
            return False
        return (span[0] > CLEAR_EFFECT and not self.b.at_most) or (span[1] < -CLEAR_EFFECT and not self.a.at_most)


@dataclass(frozen=True, kw_only=True)
class SideFacts:
    """What stands on one side."""

    name: str
    recordings: tuple[str, ...]
    radar: str
    frames: int
    antennas: int
    range_m: tuple[float, float]
    has_samples: bool


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """All that `compare` finds; `maps` and `clouds` are those of the first recording of each side."""

    sides: tuple[SideFacts, SideFacts]
    features: tuple[FeatureComparison, ...]
    axes: CommonAxes
    maps: tuple[SignalMaps, SignalMaps]
    clouds: tuple[PointCloud, PointCloud]
    map_distance_db: dict[str, float]  # mean size of the difference over the cells of the common axes
    chamfer_m: float | None  # mean over pairs of frames; None where no pair has points on both sides
    notes: tuple[str, ...]

    @property
    def ranked(self) -> list[FeatureComparison]:
        """Features that both sides show, those first that give B away most; those without an interval last."""
        return sorted((one for one in self.features if one.difference is not None), key=_rank)

    def to_values(self) -> dict[str, Any]:
        """The content of comparison.json."""
        velocity = self.axes.radial_velocity_mps
        return plain({
            "schema_version": SCHEMA_VERSION, "made_by": "mmweaver compare", "version": __version__,
            "a": self.sides[0], "b": self.sides[1],
            "common": {
                "range_m": [self.axes.range_m[0], self.axes.range_m[-1]], "reference": self.axes.reference,
                "max_velocity_mps": None if velocity is None else velocity[-1],
            },
            "features": {one.feature.name: _values(one) for one in self.features},
            "ranked": [one.feature.name for one in self.ranked],
            "gives_b_away": [one.feature.name for one in self.ranked if one.gives_away],
            "map_distance_db": self.map_distance_db, "chamfer_m": self.chamfer_m, "notes": self.notes,
        })  # fmt: skip

    def save(self, out: str | Path, *, overwrite: bool = False) -> list[Path]:
        """Writes comparison.png, comparison.json and comparison.html into a folder. Raises InputError."""
        from mmweaver.comparison.comparison_page import write_comparison

        return write_comparison(self, Path(out), overwrite=overwrite)

    def text(self) -> str:
        """The table for a terminal."""
        lines = [f"A  {_side_line(self.sides[0])}", f"B  {_side_line(self.sides[1])}", ""]
        for one in self.ranked:
            assert one.difference is not None
            span = one.difference.effect_interval_95
            effect = f"{one.difference.effect_size:+.1f}" + (
                "" if span is None else f" ({span[0]:+.1f} to {span[1]:+.1f})"
            )
            mark = "*" if one.gives_away else " "
            unit = one.feature.unit
            lines.append(f"{mark} {one.feature.title:42s} {effect:24s} A {one.a.text(unit):32s} B {one.b.text(unit)}")
        hidden = [one for one in self.features if one.difference is None]
        lines += ["", *(f"  {one.feature.title}: {_why_not(one)}" for one in hidden)]
        lines += [
            "",
            *(f"  mean difference of the {name}: {value:.1f} dB" for name, value in self.map_distance_db.items()),
        ]
        if self.chamfer_m is not None:
            lines.append(f"  Chamfer distance of the point clouds: {self.chamfer_m:.2f} m")
        lines += [f"  {note}" for note in self.notes]
        return "\n".join(lines)


def compare(
    a: Any, b: Any, *, radar: str | Path | RadarConfig | None = None, radar_b: str | Path | RadarConfig | None = None,
    layout: str | None = None, axes: str | None = None, iq_order: str | None = None,
    tx_order: tuple[int, ...] | None = None, range_m: tuple[float, float] | None = None,
) -> Comparison:  # fmt: skip
    """Compares two signals, or two folders of signals.

    `a`, `b`: a recording, a result folder, a .mmw file, a stream folder, a folder of any of these; or a RadarCube, an
    AdcCube, what `Weaver.generate`, `process_recording` or `read_recording` give, or a list of any of these. `radar`
    (of `b`: `radar_b`, default the same), `layout`, `axes`, `iq_order` and `tx_order` are for raw samples that do not
    bring their radar, see `read_recording`. `range_m`: the ranges that are compared, all by default. Raises InputError
    for what cannot be read or has no common ranges.
    """
    own = RawReading(radar=radar, layout=layout, axes=axes, iq_order=iq_order, tx_order=tx_order)
    other = RawReading(
        radar=radar if radar_b is None else radar_b, layout=layout, axes=axes, iq_order=iq_order, tx_order=tx_order
    )
    names = tuple(str(one) if isinstance(one, str | Path) else letter for one, letter in ((a, "A"), (b, "B")))
    return compare_signals(
        signals_of(a, own, "A"), signals_of(b, other, "B"), names=(names[0], names[1]), range_m=range_m
    )


def compare_signals(
    a: Sequence[ComparedSignal], b: Sequence[ComparedSignal], *, names: tuple[str, str] = ("A", "B"),
    range_m: tuple[float, float] | None = None,
) -> Comparison:  # fmt: skip
    """Compares signals in memory, one or more a side. Raises InputError where they have no common ranges."""
    sides, notes = _with_same_detector(a, b)
    labels = [name if len(side) == 1 else one.name for name, side in zip(names, sides, strict=True) for one in side]
    every = [*sides[0], *sides[1]]
    for label, one in zip(labels, every, strict=True):
        if not one.cube.values.any():
            raise InputError(f"{label} holds nothing but zeros; give a recording with a signal")
    window_m = common_window_m(labels, [shown_m(one) for one in every], range_m)
    points_m = common_window_m(labels, [one.cube.grid.range_m for one in every], range_m)
    first = [SignalEvidence(side[0], window_m, points_m) for side in sides]
    measured = [
        # of all but the first, what was computed is forgotten at once: folders hold many recordings
        [measure_all(kept), *(measure_all(SignalEvidence(one, window_m, points_m)) for one in side[1:])]
        for kept, side in zip(first, sides, strict=True)
    ]
    features = tuple(_compared(feature, measured[0], measured[1]) for feature in FEATURES)
    axes = common_axes(first[0], first[1])
    maps = maps_of(first[0], axes), maps_of(first[1], axes)
    return Comparison(
        sides=(_facts(names[0], sides[0]), _facts(names[1], sides[1])), features=features, axes=axes, maps=maps,
        clouds=(first[0].points, first[1].points), map_distance_db=_map_distances(*maps),
        chamfer_m=_chamfer(first[0], first[1]), notes=(*notes, *_notes(sides)),
    )  # fmt: skip


def measure_all(evidence: SignalEvidence) -> dict[str, SideValue]:
    """All features of one signal by name."""
    parts = evidence.quarters() if len(evidence.cube.values) < FEWEST_UNITS else None
    return {feature.name: measure(feature, evidence, parts) for feature in FEATURES}


def measure(feature: Feature, evidence: SignalEvidence, parts: SignalEvidence | None = None) -> SideValue:
    """A feature of one signal, a value a frame; of its `parts`, quarters of few frames, where these show it."""
    found, units = _seen(feature, evidence), "frames"
    if parts is not None and not feature.whole_frames and not isinstance(found, CannotSeeError):
        of_parts = _seen(feature, parts)
        if not isinstance(of_parts, CannotSeeError):
            found, units = of_parts, "quarters of frames"
    if isinstance(found, CannotSeeError):
        return SideValue(spread=None, units="", cannot_see=str(found))
    values = found.values[np.isfinite(found.values)]
    return SideValue(spread=spread_of(values, in_order=True), units=units, at_most=found.at_most, values=values)


def _seen(feature: Feature, evidence: SignalEvidence) -> FrameValues | CannotSeeError:
    try:
        with np.errstate(divide="ignore", invalid="ignore"):  # of lost frames, which are zero
            found = feature.measure(evidence)
    except CannotSeeError as reason:
        return reason
    if len(found.values) == len(evidence.is_lost):
        found = replace(found, values=np.where(evidence.is_lost, np.nan, found.values))
    return found if np.isfinite(found.values).any() else CannotSeeError("no frame shows it")


def _compared(feature: Feature, a: list[dict[str, SideValue]], b: list[dict[str, SideValue]]) -> FeatureComparison:
    by_recording = min(len(a), len(b)) >= FEWEST_RECORDINGS
    own, other = (_of_side([one[feature.name] for one in side], by_recording) for side in (a, b))
    difference = None
    if own.values is not None and other.values is not None:
        difference = difference_of(own.values, other.values, feature.tolerance, in_order=not by_recording)
    return FeatureComparison(feature=feature, a=own, b=other, difference=difference)


def _of_side(each: list[SideValue], by_recording: bool) -> SideValue:
    """Of several recordings their medians, or all their frames where recordings are few."""
    seen = [one for one in each if one.values is not None and one.spread is not None]
    if len(each) == 1 or not seen:
        return each[0]
    if by_recording:
        values = np.array([one.spread.median for one in seen if one.spread is not None])
    else:
        values = np.concatenate([one.values for one in seen if one.values is not None])
    return SideValue(
        spread=spread_of(values, in_order=not by_recording), units="recordings" if by_recording else seen[0].units,
        at_most=all(one.at_most for one in seen), values=values,
    )  # fmt: skip


def _with_same_detector(
    a: Sequence[ComparedSignal], b: Sequence[ComparedSignal]
) -> tuple[list[list[ComparedSignal]], list[str]]:
    """Stored points only where both sides were detected in the same way; else CFAR for all."""
    kinds = {one.meta.get("points") if one.points is not None else None for one in (*a, *b)}
    if len(kinds) == 1 and None not in kinds:
        return [list(a), list(b)], [f"points as stored, by {kinds.pop()}"]
    return [[replace(one, points=None) for one in side] for side in (a, b)], ["points by CFAR on both cubes"]


def _notes(sides: list[list[ComparedSignal]]) -> list[str]:
    notes = []
    configs = [side[0].cube.config for side in sides]
    if configs[0].num_antennas != configs[1].num_antennas:
        counts = " and ".join(str(one.num_antennas) for one in configs)
        notes.append(f"arrays differ, {counts} antennas: the best plane wave, antennas and azimuths with them")
    if any(not np.isclose(*values, rtol=0.2) for values in _resolutions(configs)):
        notes.append("resolutions differ: peaks over medians and sparsity depend on them")
    if any(len(side) > 1 for side in sides):
        notes.append("pictures, map distances and Chamfer are of the first recording of each side")
    return notes


def _resolutions(configs: list[RadarConfig]) -> list[tuple[float, float]]:
    a, b = configs
    return [(a.range_resolution_m, b.range_resolution_m), (a.velocity_resolution_mps, b.velocity_resolution_mps)]


def _facts(name: str, side: list[ComparedSignal]) -> SideFacts:
    config, range_m = side[0].cube.config, shown_m(side[0])
    return SideFacts(
        name=name, recordings=tuple(one.name for one in side), radar=config.name,
        frames=sum(len(one.cube.values) for one in side), antennas=config.num_antennas,
        range_m=(float(range_m[0]), float(range_m[-1])), has_samples=side[0].adc is not None,
    )  # fmt: skip


def _map_distances(a: SignalMaps, b: SignalMaps) -> dict[str, float]:
    pairs = {
        "static range profile": (a.range_profile_db, b.range_profile_db),
        "range-Doppler map": (a.range_doppler_db, b.range_doppler_db),
        "range-azimuth map": (a.range_azimuth_db, b.range_azimuth_db),
    }
    return {
        name: float(np.abs(own - other).mean())
        for name, (own, other) in pairs.items() if own is not None and other is not None
    }  # fmt: skip


def _chamfer(a: SignalEvidence, b: SignalEvidence) -> float | None:
    """Frames are paired in time, from the first on."""
    times = [one.signal.cube.grid.frame_time_s - one.signal.cube.grid.frame_time_s[0] for one in (a, b)]
    found = []
    for frame, time_s in enumerate(times[0]):
        if time_s > times[1][-1] + 0.5 * b.signal.cube.config.frame_period_s:
            break
        pair = [
            np.stack([cloud.x_m[own], cloud.y_m[own], cloud.z_m[own]], axis=1)
            for cloud, own in (
                (a.points, a.points.frame == frame), (b.points, b.points.frame == np.abs(times[1] - time_s).argmin())
            )
        ]  # fmt: skip
        if len(pair[0]) and len(pair[1]):
            found.append(chamfer_m(pair[0].astype(np.float64), pair[1].astype(np.float64)))
    return float(np.mean(found)) if found else None


def _rank(one: FeatureComparison) -> tuple[bool, float]:
    assert one.difference is not None
    return one.difference.effect_interval_95 is None, -abs(one.difference.effect_size)


def _values(one: FeatureComparison) -> dict[str, Any]:
    own = {
        key: {"value": side.spread, "of": side.units, "at_most": side.at_most, "cannot_see": side.cannot_see}
        for key, side in (("a", one.a), ("b", one.b))
    }
    return {
        "title": one.feature.title, "unit": one.feature.unit, "definition": one.feature.definition,
        "tolerance": one.feature.tolerance, **own, "difference": one.difference, "gives_b_away": one.gives_away,
    }  # fmt: skip


def _side_line(side: SideFacts) -> str:
    more = f", {len(side.recordings)} recordings" if len(side.recordings) > 1 else ""
    return (
        f"{side.name}: {side.radar}, {side.frames} frames{more}, {side.antennas} antennas,"
        f" {side.range_m[0]:.2f} to {side.range_m[1]:.2f} m, {'samples' if side.has_samples else 'cube'}"
    )


def _why_not(one: FeatureComparison) -> str:
    reasons = [
        f"{letter} {side.text(one.feature.unit) if side.spread else f'cannot be seen, {side.cannot_see}'}"
        for letter, side in (("A", one.a), ("B", one.b))
    ]
    return "; ".join(reasons)
