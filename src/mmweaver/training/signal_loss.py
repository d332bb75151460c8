"""The paper's loss: 0.5 complex SSIM, 0.3 squared error, 0.2 perceptual, on patches of range-Doppler maps.

Reference: paper, "Model Training". The perceptual part is the absolute difference of features of the activity network.
"""

import numpy as np
import torch
from torch import Tensor

from mmweaver.models.activity_network import ActivityNetwork

SHARE_CSSIM, SHARE_MSE, SHARE_PERCEPTUAL = 0.5, 0.3, 0.2
WINDOW_SIGMA, WINDOW_RADIUS, K1, K2 = 1.5, 5, 0.01, 0.03  # of SSIM (Wang et al., 2004)


def signal_loss(
    made: Tensor, truth: Tensor, span: Tensor, perceiver: ActivityNetwork, unit_sqrt_mw: float
) -> dict[str, Tensor]:
    """Terms of the loss, weighted.

    Args:
        made: Complex patches (sequence, frame, range, doppler, antenna) in the unit of the network.
        truth: Ground truth, likewise.
        span: Data range of each sequence (sequence,), largest minus smallest of all I and Q.
        perceiver: Network whose convolutional features are compared.
        unit_sqrt_mw: Value of the network's 1.0 in sqrt(mW).

    Returns:
        Terms cssim, mse and perceptual, whose sum is minimised.
    """
    similarity = torch.stack([_ssim(part(made), part(truth), span).mean() for part in (torch.real, torch.imag)]).mean()
    squared = (made - truth).abs().square().mean() / 2
    with torch.no_grad():
        wanted = perceived(perceiver, truth.flatten(0, 1) * unit_sqrt_mw)
    found = perceived(perceiver, made.flatten(0, 1) * unit_sqrt_mw)
    features = torch.stack([(one - two).abs().mean() for one, two in zip(found, wanted, strict=True)]).mean()
    return {
        "cssim": SHARE_CSSIM * (1 - similarity),
        "mse": SHARE_MSE * squared,
        "perceptual": SHARE_PERCEPTUAL * features,
    }


def perceived(network: ActivityNetwork, values: Tensor) -> list[Tensor]:
    """Convolutional features of complex maps (map, range, doppler, antenna)."""
    doppler, angle = network.maps(values)
    return network.doppler(doppler) + network.angle(angle)


def _ssim(made: Tensor, truth: Tensor, span: Tensor) -> Tensor:
    """SSIM at each cell of (sequence, frame, range, doppler, antenna); differentiable."""
    p, t = made.movedim(-1, 2), truth.movedim(-1, 2)
    c1, c2 = ((k * span)[:, None, None, None, None].square() for k in (K1, K2))
    mean_p, mean_t = _smoothed(p), _smoothed(t)
    variance_p, variance_t = _smoothed(p * p) - mean_p**2, _smoothed(t * t) - mean_t**2
    covariance = _smoothed(p * t) - mean_p * mean_t
    luminance = (2 * mean_p * mean_t + c1) / (mean_p**2 + mean_t**2 + c1)
    return luminance * (2 * covariance + c2) / (variance_p + variance_t + c2)


def _smoothed(maps: Tensor) -> Tensor:
    """Gaussian windows over the last two axes, as two matrix products; boundaries reflect, edge cells included."""
    rows, columns = (_window(size).to(maps.device) for size in maps.shape[-2:])
    return rows @ maps @ columns.T


_WINDOWS: dict[int, Tensor] = {}


def _window(size: int) -> Tensor:
    """(size, size): each row holds the window weights of one position."""
    if size not in _WINDOWS:
        taps = np.exp(-0.5 * (np.arange(-WINDOW_RADIUS, WINDOW_RADIUS + 1) / WINDOW_SIGMA) ** 2)
        places = np.pad(np.arange(size), WINDOW_RADIUS, mode="symmetric")
        window = np.zeros((size, size))
        for shift, tap in enumerate(taps / taps.sum()):
            np.add.at(window, (np.arange(size), places[shift : shift + size]), tap)
        _WINDOWS[size] = torch.from_numpy(window.astype(np.float32))
    return _WINDOWS[size]
