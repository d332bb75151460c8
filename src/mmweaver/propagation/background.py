"""A background recording in place of sampled static phases.

Static clutter is then the recording's own. How much of it a body occludes is inferred: the static paths receive the
posterior mean amplitudes given the recording.
Reference: linear Gaussian conditioning (Rasmussen and Williams, Gaussian Processes, 2006, appendix A.2).
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.mean_power import MeanPower
from mmweaver.propagation.paths import StaticPaths
from mmweaver.signal.cube import static_cube
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    moving_doppler,
    noise_power,
    range_azimuth_power,
    range_doppler_power,
)

MISFIT = 0.01  # share of the recording's mean power that a photo's geometry cannot explain
SHOWN = 1e-4  # cells above this share of the strongest are used to compare levels
MOVES = 10.0  # times the noise power: moving cells above it count as motion
NO_SCALE = "the background recording has no absolute scale: it was taken to be as strong as the scene's paths predict"
SOMEBODY = "something moves in the background recording: its mean over time was taken"


@dataclass(frozen=True, kw_only=True)
class BackgroundRecording:
    """Static clutter, noise level and scale that a recording without people provides."""

    static: Tensor  # complex (range, antenna), the cube at zero Doppler, in sqrt(mW)
    noise_power: float  # mW in a cell of the cube
    sample_noise_mw: float  # noise power per ADC sample
    unit: float  # sqrt(mW) per unit of the recording
    count_sqrt_mw: float  # sqrt(mW) per count of the converter
    assumptions: tuple[str, ...]

    @classmethod
    def of(cls, recording: RadarCube, expected: Tensor, radar: MeanPower) -> "BackgroundRecording":
        """Evaluates a recording by the same radar (`check_recording`).

        Args:
            recording: Cube without people.
            expected: Mean power (range, azimuth) in mW that the scene's paths predict; it sets the scale of a recording
                that has none.
            radar: Mean power maps of the radar, for its configuration and noise.

        Returns:
            The background, with assumptions about scale and motion in words.

        Raises:
            InputError: If a recording without scale has no cell in common with the scene's paths.
        """
        middle = radar.config.num_loops // 2
        mean = recording.values[:, :, middle].mean(axis=0, dtype=np.complex128)
        notes: list[str] = []
        unit = recording.scale
        if not np.isfinite(unit):
            own = range_azimuth_power(static_cube(mean, radar.config), azimuth_axis_rad())[0]
            unit = agreeing_gain([(expected, torch.from_numpy(own).float())])
            notes.append(NO_SCALE)
        noise = noise_power(recording)
        if noise is not None and _moves(recording, noise):
            notes.append(SOMEBODY)
        config, power = radar.config, radar.noise if noise is None else noise * unit**2
        is_calibrated = np.isfinite(recording.scale)  # else 1.0 is a count of the converter
        return cls(
            static=torch.from_numpy((mean * unit).astype(np.complex64)),
            unit=float(unit),
            noise_power=float(power),
            sample_noise_mw=float(power * config.noise_power_mw / radar.noise),
            count_sqrt_mw=config.adc_count_sqrt_mw if is_calibrated else float(unit),
            assumptions=tuple(notes),
        )

    def conditioned(self, paths: StaticPaths, renderer: CubeRenderer) -> StaticPaths:
        """Static paths with the amplitudes that are most likely given the recording.

        A priori each amplitude is multiplied by an independent complex Gaussian of mean power 1.

        Args:
            paths: Static paths of the scene, (path,).
            renderer: Renderer of the radar that made the recording.

        Returns:
            The same paths with posterior mean amplitudes.
        """
        seen = renderer.static(paths).each()  # (range and antenna, path)
        wanted = self.static.flatten()
        misfit = MISFIT * float(wanted.abs().square().mean()) + self.noise_power
        if seen.shape[0] <= seen.shape[1]:
            both = seen @ seen.mH
            both.diagonal().add_(misfit)
            times = seen.mH @ torch.linalg.solve(both, wanted)
        else:
            both = seen.mH @ seen
            both.diagonal().add_(misfit)
            times = torch.linalg.solve(both, seen.mH @ wanted)
        return replace(paths, amplitude=times * paths.amplitude)


def check_recording(recording: RadarCube, config: RadarConfig) -> None:
    """Checks that a background recording fits the radar.

    Args:
        recording: Cube without people.
        config: The radar to generate for; its name and frame period may differ.

    Raises:
        InputError: If the recording is from a radar with other settings, empty, zero or not finite.
    """
    own = {field.name for field in fields(config)} - {"name", "frame_period_s"}
    if any(getattr(recording.config, name) != getattr(config, name) for name in own):
        raise InputError(
            f"the background was recorded by {recording.config.name!r} with other settings than those of"
            f" {config.name!r}; generate for the radar that recorded it (its radar.json)"
        )
    if not len(recording.values) or not np.isfinite(recording.values).all() or not recording.values.any():
        raise InputError("the background recording holds no signal, or values that are not finite")


def agreeing_gain(maps: Sequence[tuple[Tensor, Tensor]]) -> float:
    """Amplitude factor that brings recorded power maps to the level of expected ones.

    The median log ratio over the cells that are visible in both.

    Args:
        maps: Pairs of (expected, recorded) power maps of equal shape.

    Returns:
        Factor of the recorded amplitude.

    Raises:
        InputError: If no cell is visible in both.
    """
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
