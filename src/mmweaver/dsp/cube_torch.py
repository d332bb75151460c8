"""`radar_cube` in torch, on any device."""

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.dsp.cube import doppler_weight, tdm_compensation
from mmweaver.dsp.windows import hann


def torch_cube(samples: Tensor, config: RadarConfig) -> Tensor:
    """ADC samples (frame, loop, tx, rx, sample) -> cube values (frame, range, doppler, antenna), complex64.

    The same transforms, windows and TDM compensation as `dsp.cube.radar_cube`, which says what they are.
    """
    device = samples.device
    window = hann(config.num_samples)
    weight = torch.from_numpy(window / window.sum()).to(device, torch.float32)
    if config.complex_samples:
        spectrum = torch.fft.fft(samples * weight, dim=-1)
    else:
        spectrum = torch.fft.rfft(samples.real * (2 * weight), dim=-1)
    first = config.first_range_bin
    kept = spectrum[..., first : first + config.num_range_bins].flatten(2, 3)  # (frame, loop, antenna, range)
    slow = kept.permute(0, 3, 1, 2) * torch.from_numpy(doppler_weight(config.num_loops)).to(device)[:, None]
    return torch.fft.fft(slow, dim=2) * torch.from_numpy(tdm_compensation(config)).to(device)
