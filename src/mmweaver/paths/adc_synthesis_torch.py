"""`synthesis` and `receiver` in torch, for many frames at once: the same equations, on the CPU or a GPU.

Phases are counted in double precision and everything else in single, as there; tests hold both to the same samples.
Frames are padded to the longest with rows of amplitude zero. Reference: docs/radar_primer.md, equations 7 and 12.
"""

import math
from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.seeding import stream
from mmweaver.paths.adc_synthesis import EchoRows, FrameClock
from mmweaver.paths.receiver import Receiver
from mmweaver.paths.static_paths import StaticEchoes

COARSE = 16  # samples of which the fast-time factor is made, and steps between them


class TorchSynthesis:
    """One radar's synthesis on one device."""

    def __init__(self, clock: FrameClock, device: str | torch.device = "cpu"):
        self.clock, self.config, self.device = clock, clock.config, torch.device(device)
        self.to_chirps, self.to_blocks = self._double(clock.to_chirps), self._double(clock.to_blocks)
        self.slope_at_blocks, self.centre_m = self._double(clock.slope_at_blocks), self._double(clock.centre_m)
        self.tx_m = self._double(np.asarray(self.config.tx_position_m))
        self.rx_m = self._double(np.asarray(self.config.rx_position_m))

    def moving(self, rows: Sequence[EchoRows]) -> Tensor:
        """ADC samples of some frames, complex64 (frame, loop, tx, rx, sample), in sqrt(mW)."""
        if self.device.type == "cpu":  # frame by frame: nothing is padded, and the caches hold it
            return torch.cat([self._moving([one]) for one in rows])
        return self._moving(rows)

    def _moving(self, rows: Sequence[EchoRows]) -> Tensor:
        config, clock = self.config, self.clock
        out_m = self._double(_padded([one.out_m for one in rows]))  # (frame, row, node, 3)
        back_m = self._double(_padded([one.back_m for one in rows]))
        amplitude = self._complex(_padded([one.amplitude for one in rows]))
        mixed = torch.from_numpy(_padded([one.is_mixed for one in rows])).to(self.device)
        frames, count = amplitude.shape
        adc = torch.zeros(
            frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples,
            dtype=torch.complex64, device=self.device,
        )  # fmt: skip
        if count == 0:
            return adc
        way_m = out_m.norm(dim=-1) + back_m.norm(dim=-1)
        shift_hz = way_m @ self.slope_at_blocks / config.wavelength_m  # (frame, row, block)
        carrier = phasor(way_m @ self.to_chirps / config.wavelength_m) * amplitude[..., None]
        carrier = carrier.unflatten(-1, (config.num_loops, config.num_tx))
        out_m = torch.einsum("frnc,nb->bfrc", out_m, self.to_blocks)
        back_m = torch.einsum("frnc,nb->bfrc", back_m, self.to_blocks)
        for index, block in enumerate(clock.blocks):
            first, last = int(block[0]), int(block[-1]) + 1
            out, back = out_m[index], back_m[index]
            array = self._array(out, back) + mixed[..., None, None] * self._array(back, out)
            for m in range(config.num_tx):
                slow = carrier[:, :, first:last, m, None] * array[:, :, None, m]  # (frame, row, loop, rx)
                centre = self.centre_m[m]
                delay_s = ((out - centre).norm(dim=-1) + (back - centre).norm(dim=-1)) / SPEED_OF_LIGHT_MPS
                product = slow.flatten(2).transpose(1, 2) @ self._fast_time(delay_s, shift_hz[..., index])
                adc[:, first:last, m] = product.unflatten(1, (last - first, config.num_rx))
        return adc

    def resting(self, echoes: Sequence[StaticEchoes]) -> Tensor:
        """ADC samples of what rests in each frame, complex64 (frame, tx, rx, sample)."""
        way_m = self._double(_padded([one.way_m for one in echoes]))
        amplitude = self._complex(_padded([one.amplitude for one in echoes]))
        slow = phasor(way_m / self.config.wavelength_m) * amplitude[..., None, None]
        delay_s = way_m.mean(dim=-1) / SPEED_OF_LIGHT_MPS
        each = [
            slow[:, :, m].transpose(1, 2) @ self._fast_time(delay_s[..., m], torch.zeros_like(delay_s[..., m]))
            for m in range(self.config.num_tx)
        ]
        return torch.stack(each, dim=1)

    def received(
        self, person: Tensor, room: Tensor, room_rate: Tensor, receiver: Receiver, frames: np.ndarray, *,
        drawn_here: bool = False,
    ) -> Tensor:  # fmt: skip
        """`Receiver.receive` for frames of these numbers; room (frame, tx, rx, sample), its rate (tx, rx, sample).

        Noise comes from the receiver's own streams, or with `drawn_here` from this device's generator, which is
        quicker on a GPU and gives other noise of the same kind.
        """
        config, impairments = self.config, receiver.impairments
        draw = self._drawn if drawn_here else self._streamed
        shift, noise = draw(receiver, frames, person.shape)
        samples = person + room[:, None] + shift[:, :, :, None, :] * room_rate
        if impairments.channel_gain_db or impairments.channel_phase_rad:
            samples = samples * self._complex(receiver.channels)[:, :, None]
        samples = samples + noise
        if not config.complex_samples:
            samples = torch.complex(samples.real, torch.zeros_like(samples.real))
        if impairments.quantise:
            count = config.adc_count_sqrt_mw
            parts = torch.view_as_real(samples)
            samples = torch.view_as_complex((parts / count).round().clamp(-32768, 32767) * count)
        return samples

    def _streamed(self, receiver: Receiver, frames: np.ndarray, shape: torch.Size) -> tuple[Tensor, Tensor | float]:
        shift = np.stack([receiver.shift(int(frame)) for frame in frames])
        noise = 0.0
        if receiver.impairments.thermal_noise:
            noise = np.stack([receiver.noise(tuple(shape[1:]), int(frame)) for frame in frames])
            noise = torch.from_numpy(noise).to(self.device)
        return torch.from_numpy(shift).to(self.device), noise

    def _drawn(self, receiver: Receiver, frames: np.ndarray, shape: torch.Size) -> tuple[Tensor, Tensor | float]:
        generator = torch.Generator(self.device)
        generator.manual_seed(int(stream(receiver.seed, "device noise", int(frames[0])).integers(2**62)))
        size = (shape[0], shape[1], shape[2])
        late = torch.rand((*size, 1), generator=generator, device=self.device) < 0.5
        white = torch.randn((*size, shape[-1]), generator=generator, device=self.device)
        shift = (late.to(white.dtype) - 0.5) * receiver.impairments.chirp_jitter_s + white * receiver.phase_noise_s
        noise = torch.randn((*shape, 2), generator=generator, device=self.device) * receiver.noise_sqrt_mw
        return shift, torch.view_as_complex(noise)

    def _fast_time(self, delay_s: Tensor, shift_hz: Tensor) -> Tensor:
        """Fast-time factor (frame, row, sample); `synthesis.fast_time`."""
        config = self.config
        slope, num = config.chirp_slope_hz_per_s, config.num_samples
        turns_a_sample = ((slope * delay_s + shift_hz) / config.sample_rate_hz)[..., None]
        fine = phasor(turns_a_sample * torch.arange(COARSE, device=self.device))
        steps = COARSE * torch.arange(-(-num // COARSE), device=self.device) - num / 2
        rough = phasor(turns_a_sample * steps - (slope * delay_s**2 / 2)[..., None])
        return (rough[..., :, None] * fine[..., None, :]).flatten(-2)[..., :num]

    def _array(self, out_m: Tensor, back_m: Tensor) -> Tensor:
        """Near-field phases (frame, row, tx, rx); `synthesis.array_factor`."""
        return self._to_each(out_m, self.tx_m)[..., :, None] * self._to_each(back_m, self.rx_m)[..., None, :]

    def _to_each(self, place_m: Tensor, antenna_m: Tensor) -> Tensor:
        distance = place_m.norm(dim=-1)[..., None]
        excess = antenna_m.square().sum(dim=-1) - 2 * (place_m @ antenna_m.T)
        difference = excess / ((distance.square() + excess).clamp(min=0).sqrt() + distance).clamp(min=1e-9)
        return phasor(difference / self.config.wavelength_m)

    def _double(self, values: np.ndarray) -> Tensor:
        return torch.from_numpy(np.ascontiguousarray(values, dtype=np.float64)).to(self.device)

    def _complex(self, values: np.ndarray) -> Tensor:
        return torch.from_numpy(np.ascontiguousarray(values, dtype=np.complex64)).to(self.device)


def phasor(turns: Tensor) -> Tensor:
    """exp(2 pi j turns), complex64; wrapped in double precision first."""
    angle = ((turns - turns.round()) * (2 * math.pi)).to(torch.float32)
    return torch.complex(angle.cos(), angle.sin())


def _padded(parts: list[np.ndarray]) -> np.ndarray:
    """(frame, row, ...) with zeros where a frame has fewer rows."""
    longest = max(len(part) for part in parts)
    out = np.zeros((len(parts), longest, *parts[0].shape[1:]), parts[0].dtype)
    for row, part in zip(out, parts, strict=True):
        row[: len(part)] = part
    return out
