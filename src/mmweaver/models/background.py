"""A recording of the empty room in the place of drawn phases.

What rests is then the recording's own, to the bit but for its noise. How much of it a body hides is inferred: the
network's resting echoes are given the amplitudes that, of all they might have, explain the recording best.
Reference: linear Gaussian conditioning (Rasmussen and Williams, Gaussian Processes, 2006, appendix A.2); decision 104.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.dsp.cube import static_cube
from mmweaver.dsp.spectra import azimuth_axis_rad, moving_doppler, noise_power, range_azimuth_power, range_doppler_power
from mmweaver.paths.mean_power import MeanPower
from mmweaver.paths.random_phases import SampledStaticClutter

MISFIT = 0.01  # of the recording's mean power is not to be explained by a photo's geometry
SHOWN = 1e-4  # of the strongest cell: what levels are compared by
MOVES = 10.0  # times the noise
NO_SCALE = "the recording of the empty room has no absolute scale: it was taken to be as strong as the network expects"
SOMEBODY = "something moves in the recording of the empty room: its mean over time was taken"


@dataclass(frozen=True, kw_only=True)
class BackgroundRecording:
    """What rests, (range, antenna) in centred phase and sqrt(mW), and the noise power of a cell in mW."""

    still: Tensor
    noise_power: float
    unit: float  # sqrt(mW) of 1.0 in the recording
    assumptions: tuple[str, ...]

    @classmethod
    def of(cls, recording: RadarCube, expected: Tensor, radar: MeanPower) -> "BackgroundRecording":
        """Of a recording by the same radar; `expected` (range, azimuth) is the mean power that the network says, which
        gives a recording its scale where it has none. Raises InputError for another radar's, or one of no numbers.
        """
        check_recording(recording, radar.config)
        middle = radar.config.num_loops // 2
        mean = recording.values[:, :, middle].mean(axis=0, dtype=np.complex128)
        told: list[str] = []
        unit = recording.scale
        if not np.isfinite(unit):
            own = range_azimuth_power(static_cube(mean, radar.config), azimuth_axis_rad())[0]
            unit = agreeing_gain([(expected, torch.from_numpy(own).float())])
            told.append(NO_SCALE)
        noise = noise_power(recording)
        if noise is not None and _moves(recording, noise):
            told.append(SOMEBODY)
        turn = radar.response.turn(radar.axes)[:, middle]
        return cls(
            still=torch.from_numpy((mean * unit).astype(np.complex64)) / turn, unit=float(unit),
            noise_power=radar.noise if noise is None else noise * unit**2, assumptions=tuple(told),
        )  # fmt: skip

    def conditioned(self, drawn: SampledStaticClutter) -> SampledStaticClutter:
        """The resting echoes with the amplitudes that the recording makes most likely; their layer is the recording.

        Each drawn echo may be any complex number of times as strong, of mean power 1 (a priori).
        """
        seen = torch.einsum("kr,ka->rak", drawn.at_range, drawn.echo).flatten(0, 1)  # (range and antenna, echo)
        wanted = self.still.flatten()
        misfit = MISFIT * float(wanted.abs().square().mean()) + self.noise_power
        if seen.shape[0] <= seen.shape[1]:
            both = seen @ seen.mH
            both.diagonal().add_(misfit)
            times = seen.mH @ torch.linalg.solve(both, wanted)
        else:
            both = seen.mH @ seen
            both.diagonal().add_(misfit)
            times = torch.linalg.solve(both, seen.mH @ wanted)
        return replace(drawn, echo=times[:, None] * drawn.echo, recorded=self.still)


def check_recording(recording: RadarCube, config: RadarConfig) -> None:
    """Raises InputError for a recording of another radar, of no numbers, or of nothing."""
    own = {field.name for field in fields(config)} - {"name", "frame_period_s"}
    if any(getattr(recording.config, name) != getattr(config, name) for name in own):
        raise InputError(
            f"the empty room was recorded by {recording.config.name!r} with other settings than those of"
            f" {config.name!r}; generate for the radar that recorded it (its radar.json)"
        )
    if not len(recording.values) or not np.isfinite(recording.values).all() or not recording.values.any():
        raise InputError("the recording of the empty room holds no signal, or values that are no numbers")


def agreeing_gain(maps: Sequence[tuple[Tensor, Tensor]]) -> float:
    """The factor of amplitude at which recorded power maps agree with expected ones, pairs of (expected, recorded), by
    the median of what both show. Raises InputError where they show nothing in common."""
    ratios = []
    for expected, own in maps:
        shown = (own > SHOWN * own.max()) & (expected > SHOWN * expected.max())
        ratios.append((expected[shown] / own[shown]).log())
    both = torch.cat(ratios)
    if not len(both):
        raise InputError(
            "the recording shows no echo where the photo has a surface, so its scale cannot be found; is it of this"
            " room, and is the range window that of the room?"
        )
    return float(both.median().div(2).exp())


def _moves(recording: RadarCube, noise: float) -> bool:
    power = range_doppler_power(recording).mean(axis=0)[:, moving_doppler(recording)]
    return bool(power.max() > MOVES * noise)
