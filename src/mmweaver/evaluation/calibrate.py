"""`mmweaver.calibrate`: estimates the board that made recordings, as far as they reveal it.

    recordings --fits, each in closed form--> findings --> Board

Every fit reports its result, or why it cannot be determined. Reference: docs/board.md.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.board import Board
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import chosen_range

# imported to register their fits
from mmweaver.evaluation import antenna_fits, receiver_fits, time_fits  # noqa: F401
from mmweaver.evaluation.compared_sides import signals_of
from mmweaver.evaluation.finding import SIGNAL_FITS, Finding
from mmweaver.evaluation.signal_evidence import SignalEvidence
from mmweaver.evaluation.target_fits import KnownTarget, fit_target, unknown_targets
from mmweaver.recordings.plausibility import implausible
from mmweaver.recordings.read_recording import RawReading

NEVER_SEEN = (
    Finding(title="coupling between antennas", text="it takes one target at many known directions"),
    Finding(title="element spacing", text="it takes a target at known directions"),
    Finding(title="elevation offset", text="it takes a target at a known height"),
)


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """A board estimated from recordings.

    Attributes:
        board: The board.
        findings: What each fit found, or why it found nothing.
        warnings: Signs of misread samples, which invalidate the board.
    """

    board: Board
    findings: tuple[Finding, ...]
    warnings: tuple[str, ...] = ()

    def text(self) -> str:
        """Formats warnings, results, and what could not be determined, one line each."""
        lines = [f"warning: {one}; what follows may be wrong" for one in self.warnings]
        for title, found in (("found", True), ("not seen", False)):
            lines += [title, *(f"  {one}: {text}" for one, text in self._texts(found).items())]
        return "\n".join(lines)

    def to_values(self) -> dict[str, Any]:
        """The same as plain JSON values; tables are part of the board."""
        return {
            "board": self.board.to_values(),
            "errors": {name: round(error, 4) for one in self.findings for name, error in one.errors.items()},
            "found": self._texts(True),
            "not_seen": self._texts(False),
            "warnings": list(self.warnings),
        }

    def _texts(self, found: bool) -> dict[str, str]:
        return {one.title: one.text for one in self.findings if one.is_found == found}


def calibrate(
    *recordings: Any,
    radar: str | Path | RadarConfig | None = None,
    range_m: tuple[float, float] | None = None,
    range_bins: tuple[int, int] | None = None,
    target: KnownTarget | None = None,
    name: str | None = None,
    **samples: Any,
) -> Calibration:
    """Estimates the board that made recordings of any room, with or without people, without labels.

    Args:
        *recordings: Paths as in `mmweaver compare`, RadarCubes, AdcCubes, or results of `process_recording` and
            `Weaver.generate`; all from one radar with the same settings.
        radar: Radar of raw samples: name of a preset, file, or RadarConfig.
        range_m: Ranges (near, far) in metres from which the antennas are estimated. Default: all.
        range_bins: The same as range bins (first, last).
        target: Target at a known distance in the recordings. Default: none.
        name: Name of the board. Default: from the recordings.
        **samples: `layout`, `axes`, `iq_order` and `tx_order` of raw samples, see `read_recording`.

    Returns:
        The board, with what was found and what could not be determined.

    Raises:
        InputError: If a recording cannot be read, or radars differ.
    """
    if not recordings:
        raise InputError("which recordings? give one or more")
    reading = RawReading(radar=radar, **samples)
    signals = [one for source in recordings for one in signals_of(source, reading, "recording")]
    evidence = [SignalEvidence(one, _window(one.cube.config, range_m, range_bins)) for one in signals]
    _check_same_radar(evidence)
    findings = [fit(evidence) for fit in SIGNAL_FITS]
    findings += unknown_targets() if target is None else fit_target(evidence, target)
    findings += NEVER_SEEN
    fields = {field: value for one in findings for field, value in one.fields.items()}
    missed = tuple(f"{one.title}: {one.text}" for one in findings if not one.is_found)
    names = ", ".join(Path(one).name if isinstance(one, str | Path) else type(one).__name__ for one in recordings)
    board = Board(name=name or f"board of {names}"[:200], made_from=names[:1000], notes=missed, **fields)
    return Calibration(board=board, findings=tuple(findings), warnings=_warnings(evidence))


def _warnings(evidence: Sequence[SignalEvidence]) -> tuple[str, ...]:
    """Signs that raw samples do not match the radar: a wrong antenna order would pass for errors of the board."""
    found = [implausible(one.signal.adc, one.cube) for one in evidence if one.signal.adc is not None]
    return tuple(dict.fromkeys(text for texts in found for text in texts))


def _window(
    config: RadarConfig, range_m: tuple[float, float] | None, range_bins: tuple[int, int] | None
) -> tuple[float, float]:
    """Nearest and farthest range used. Raises InputError if the radar lacks it."""
    if range_m is None and range_bins is None:
        return 0.0, math.inf
    chosen = chosen_range(config, range_m, range_bins)
    return float(chosen.range_m[0]), float(chosen.range_m[-1])


def _check_same_radar(evidence: Sequence[SignalEvidence]) -> None:
    """Raises InputError if recordings were made by different radars."""
    first = evidence[0].cube.config
    for one in evidence[1:]:
        own = one.cube.config
        same = ("start_frequency_hz", "chirp_slope_hz_per_s", "num_samples", "sample_rate_hz", "num_loops", "tx_order")
        if any(getattr(own, name) != getattr(first, name) for name in same) or own.num_rx != first.num_rx:
            raise InputError(
                f"{one.signal.name} was recorded with another radar or other settings; calibrate one at a time"
            )
