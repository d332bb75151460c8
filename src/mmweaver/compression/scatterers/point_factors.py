"""Scatterers of several frames and the short factors of their echoes, as NumPy arrays.

`signal.point_response.PointResponse` in the form that a fit needs hundreds of times: bins spaced by one, factors
of all frames at once, products frame by frame.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch

from mmweaver.signal.point_response import Axes, PointResponse, Points

Array = np.ndarray


@dataclass(frozen=True, kw_only=True)
class FactorAxes:
    """A response, and the cells that its factors are evaluated at."""

    response: PointResponse
    first_range: float
    num_range: int
    first_doppler: float
    num_doppler: int
    place: Array  # (antenna, 2) wavelengths
    delay: Array  # (antenna,)
    parts: Array  # (2, antenna, 2)

    @classmethod
    def of(cls, response: PointResponse, axes: Axes) -> "FactorAxes":
        """The cells of `axes`, which must be spaced by one bin."""
        return cls(
            response=response,
            first_range=float(axes.range_bin[0]),
            num_range=len(axes.range_bin),
            first_doppler=float(axes.doppler_bin[0]),
            num_doppler=len(axes.doppler_bin),
            place=axes.place.numpy(),
            delay=axes.delay.numpy(),
            parts=axes.parts.numpy(),
        )


@dataclass(kw_only=True)
class PointFactors:
    """Parameters of scatterers (frame, point) and their factors, see `PointResponse.factors`."""

    axes: FactorAxes
    bins: Array  # (2, frame, point) range and Doppler
    direction: Array  # (frame, point, 2)
    amplitude: Array  # (frame, point) complex64
    at_range: Array  # (2, frame, point, range) values of the kernel, and slopes
    at_doppler: Array  # (2, frame, point, doppler)
    steer: Array  # (frame, point, antenna) complex64

    @classmethod
    def evaluate(cls, axes: FactorAxes, bins: Array, direction: Array, amplitude: Array) -> "PointFactors":
        """Factors of scatterers with these parameters.

        Args:
            axes: Response and cells.
            bins: Range and Doppler bins (2, frame, point).
            direction: Direction cosines (frame, point, 2).
            amplitude: Amplitudes (frame, point), complex64.
        """
        response = axes.response
        return cls(
            axes=axes,
            bins=bins,
            direction=direction,
            amplitude=amplitude,
            at_range=response.range_kernel.bin_values(axes.first_range, axes.num_range, bins[0]),
            at_doppler=response.doppler_kernel.bin_values(axes.first_doppler, axes.num_doppler, bins[1]),
            steer=_steering(axes, bins, direction),
        )

    @classmethod
    def of(cls, points: Points, response: PointResponse, axes: Axes) -> "PointFactors":
        """Factors of scatterers.

        Args:
            points: Scatterers (frame, point).
            response: Point response of the window.
            axes: Cells to evaluate at.
        """
        bins = np.stack([points.range_bin.numpy(), points.doppler_bin.numpy()])
        own = FactorAxes.of(response, axes)
        return cls.evaluate(own, bins, points.direction.numpy(), points.amplitude.numpy())

    def points(self) -> Points:
        """The scatterers."""
        return Points(
            range_bin=torch.from_numpy(self.bins[0]),
            doppler_bin=torch.from_numpy(self.bins[1]),
            direction=torch.from_numpy(self.direction),
            amplitude=torch.from_numpy(self.amplitude),
        )

    def counts(self) -> Array:
        """Number of scatterers of each frame (frame,), up to the last one that is not padding."""
        is_real = self.amplitude != 0
        num = is_real.shape[1]
        return (
            np.where(is_real.any(axis=1), num - is_real[:, ::-1].argmax(axis=1), 0)
            if num
            else np.zeros(len(is_real), int)
        )

    def moved(self, step: Array, largest_bins: float, largest_direction: float) -> "PointFactors":
        """The scatterers after a step.

        Args:
            step: Changes (frame, point, 6) of bins, directions, real and imaginary amplitude.
            largest_bins: Limit of the change in bins.
            largest_direction: Limit of the change in direction cosines.
        """
        bins = self.bins + np.moveaxis(step[..., :2].clip(-largest_bins, largest_bins), -1, 0)
        direction = self.direction + step[..., 2:4].clip(-largest_direction, largest_direction)
        amplitude = self.amplitude + step[..., 4] + np.complex64(1j) * step[..., 5]
        amplitude[self.amplitude == 0] = 0
        return self.evaluate(self.axes, bins, direction.clip(-1, 1), amplitude)

    def joined(self, frame: Array, bins: Array, direction: Array, amplitude: Array) -> "PointFactors":
        """The scatterers with more of them, after those of their frames.

        Args:
            frame: Frame (point,) of each new scatterer, increasing.
            bins: Range and Doppler bins (2, point).
            direction: Direction cosines (point, 2).
            amplitude: Amplitudes (point,), complex64.
        """
        have, more = self.counts(), np.bincount(frame, minlength=self.amplitude.shape[0])
        slot = have[frame] + np.arange(len(frame)) - (np.cumsum(more) - more)[frame]
        kept, num = int(have.max(initial=0)), int((have + more).max(initial=0))
        new = self.evaluate(self.axes, bins[:, None], direction[None], amplitude[None])
        axes = {"bins": 2, "direction": 1, "amplitude": 1, "at_range": 2, "at_doppler": 2, "steer": 1}
        out = {}
        for name, axis in axes.items():
            before, values = getattr(self, name), getattr(new, name)
            shape = list(before.shape)
            shape[axis] = num
            joined = np.zeros(shape, before.dtype)
            lead = (slice(None),) * (axis - 1)
            joined[(*lead, slice(None), slice(0, kept))] = before[(*lead, slice(None), slice(0, kept))]
            joined[(*lead, frame, slot)] = values[(*lead, 0)]
            out[name] = joined
        return PointFactors(axes=self.axes, **out)

    def take(self, other: "PointFactors", frame: int) -> None:
        """Replaces the scatterers of one frame.

        Args:
            other: Set to take them from.
            frame: Index of the frame.
        """
        for name in ("bins", "at_range", "at_doppler"):
            getattr(self, name)[:, frame] = getattr(other, name)[:, frame]
        for name in ("direction", "amplitude", "steer"):
            getattr(self, name)[frame] = getattr(other, name)[frame]

    def rendered(self, frame: int, count: int, first: int = 0) -> Array:
        """Response of some scatterers of a frame in centred phase.

        Args:
            frame: Index of the frame.
            count: Index after the last scatterer.
            first: Index of the first scatterer.

        Returns:
            Real values (range, (doppler, antenna, part)).
        """
        axes, response, own, count = self.axes, self.axes.response, slice(first, count), count - first
        echo = self.amplitude[frame, own, None] * self.steer[frame, own]
        along = np.float32(response.num_loops / (2 * math.pi) * response.migration) * self.bins[1, frame, own, None]
        a_wavelength = np.float32(response.config.wavelength_m / (2 * response.range_a_bin_m))
        nearer = self.direction[frame, own] @ (axes.place.T * a_wavelength)
        # indexed by value or slope of the range kernel, then by value or slope of the Doppler kernel
        parts = np.zeros((2, count, 2, len(axes.place)), np.complex64)
        parts[0, :, 0] = echo
        np.multiply(echo, nearer, out=parts[1, :, 0])
        np.multiply(echo, np.complex64(-1j) * along, out=parts[1, :, 1])
        right = self.at_doppler[:, frame, own].transpose(1, 2, 0) @ parts.view(np.float32)
        left = self.at_range[:, frame, own].reshape(2 * count, -1)
        return left.T @ right.reshape(2 * count, -1)


def _steering(axes: FactorAxes, bins: Array, direction: Array) -> Array:
    turns = bins[1][..., None] * axes.delay
    turns -= direction @ axes.place.T
    # the wavefront's curvature, see PointResponse
    response = axes.response
    reciprocal = 0.5 * response.config.wavelength_m / response.range_a_bin_m / np.maximum(bins[0], 1.0)
    square = np.square(axes.parts).sum(axis=(0, 2))
    lag = square - np.square(direction @ axes.parts[0].T) - np.square(direction @ axes.parts[1].T)
    turns += lag * reciprocal[..., None].astype(np.float32)
    turns *= np.float32(2 * math.pi)
    out = np.empty(turns.shape, np.complex64)
    np.cos(turns, out=out.real)
    np.sin(turns, out=out.imag)
    return out
