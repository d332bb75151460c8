"""A small time-frequency diffusion over chirps: what RF-Diffusion does, at a size that a CPU trains.

Noise is added in slow time while a window closes over the chirps, which blurs their spectrum; a network restores the
signal of one frame, (loop, range, antenna), from that, the person's joints and the photo. Written from the paper's
equations (Chi et al., MobiCom 2024); its code is GPL and was not taken. Its network is a transformer of 75 million
parameters, this one has convolutions over the loops and two million. Range and antenna are channels.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mmweaver.core.radar_config import RadarConfig

WIDTH, BLOCKS = 256, 3
JOINT_VALUES, PICTURE = 22 * 6, (5, 12, 16)
CLOSING = 1.5  # how many standard deviations of the window the frame is long when all is noise
SAMPLING_STEPS = 25


@dataclass(frozen=True, kw_only=True)
class FrameBatch:
    """Frames of sequences in slow time, and what they are to be generated from."""

    signal: Tensor  # (frame, loop, range, antenna) complex, of unit variance in each range
    motion: Tensor  # (frame, 132) joints and velocities, divided by 2
    picture: Tensor  # (frame, 960) the room's photo, small
    time: Tensor  # (frame,) 0: signal, 1: noise
    noise: Tensor  # as signal


class SignalDiffusion(nn.Module):
    """Restores frames: (frame, loop, channel) noisy values -> the clean ones."""

    def __init__(self, config: RadarConfig) -> None:
        super().__init__()
        self.shape = (config.num_loops, config.num_range_bins, config.num_antennas)
        channels = 2 * self.shape[1] * self.shape[2]
        self.enter, self.leave = nn.Linear(channels, WIDTH), nn.Linear(WIDTH, channels)
        self.of_motion = nn.Sequential(nn.Linear(JOINT_VALUES, WIDTH), nn.GELU(), nn.Linear(WIDTH, WIDTH))
        self.of_picture = nn.Linear(math.prod(PICTURE), WIDTH // 2)
        self.join = nn.Linear(WIDTH + WIDTH // 2 + 16, WIDTH)
        self.blocks = nn.ModuleList(_Block() for _ in range(BLOCKS))
        nn.init.zeros_(self.leave.weight)
        nn.init.zeros_(self.leave.bias)
        self.register_buffer("unit_log", torch.zeros(config.num_range_bins))

    @property
    def unit(self) -> Tensor:
        """What signals are divided by in each range, (range,), sqrt(mW)."""
        return 10.0**self.unit_log

    def set_unit(self, unit: Tensor) -> None:
        """Sets it; its logarithm is what is stored, which half precision holds to a percent."""
        self.unit_log = unit.log10()

    def forward(self, noisy: Tensor, time: Tensor, motion: Tensor, picture: Tensor) -> Tensor:
        """Complex (frame, loop, range, antenna) at times (frame,) -> the same without noise and window."""
        turns = time[:, None] * 2.0 ** torch.arange(8) * (math.pi / 2)
        known = [self.of_motion(motion), self.of_picture(picture), turns.sin(), turns.cos()]
        code = self.join(torch.cat(known, dim=-1))
        h = self.enter(torch.view_as_real(noisy).flatten(2))
        for block in self.blocks:
            h = block(h, code)
        restored = torch.view_as_complex(self.leave(h).unflatten(2, (*self.shape[1:], 2)).contiguous())
        level, _ = levels(time, self.shape[0])
        return noisy * level.mean(1)[:, None, None, None] + restored


class _Block(nn.Module):
    """A convolution over the loops, moved by what is known."""

    def __init__(self) -> None:
        super().__init__()
        self.norm, self.move = nn.LayerNorm(WIDTH), nn.Linear(WIDTH, 2 * WIDTH)
        self.over_loops = nn.Conv1d(WIDTH, WIDTH, 5, padding=2, groups=4, padding_mode="circular")
        self.mix = nn.Linear(WIDTH, WIDTH)

    def forward(self, h: Tensor, code: Tensor) -> Tensor:
        scale, shift = self.move(nn.functional.silu(code))[:, None].chunk(2, dim=-1)
        moved = self.norm(h) * (1 + scale) + shift
        return h + self.mix(nn.functional.gelu(self.over_loops(moved.transpose(1, 2)).transpose(1, 2)))


def levels(time: Tensor, loops: int) -> tuple[Tensor, Tensor]:
    """What is left of the signal in each loop (frame, loop), and the level of the noise (frame,)."""
    place = (torch.arange(loops) - (loops - 1) / 2) / (loops / 2)
    window = torch.exp(-0.5 * (CLOSING * time[:, None] * place) ** 2)
    return torch.cos(time * math.pi / 2)[:, None] * window, torch.sin(time * math.pi / 2)


def mixed(signal: Tensor, noise: Tensor, time: Tensor) -> Tensor:
    """The signal on its way to noise."""
    level, noisy = levels(time, signal.shape[1])
    return level[:, :, None, None] * signal + noisy[:, None, None, None] * noise


def sampled(network: SignalDiffusion, start: Tensor, begin: float, motion: Tensor, picture: Tensor) -> Tensor:
    """Frames restored step by step from `start`, which is as noisy as time `begin` says."""
    x, steps = start, max(1, round(SAMPLING_STEPS * begin))
    for number in range(steps):
        now, then = (torch.full((len(x),), begin * (1 - step / steps)) for step in (number, number + 1))
        clean = network(x, now, motion, picture)
        level, noisy = levels(now, x.shape[1])
        noise = (x - level[:, :, None, None] * clean) / noisy[:, None, None, None].clamp(min=1e-3)
        x = mixed(clean, noise, then)
    return x
