"""The loss is minimal at the true mean."""

import numpy as np
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.mean_power import MeanEchoes, MeanPower
from mmweaver.propagation.radar_equation import points_of
from mmweaver.training.network_loss import STEEPEST, Targets, itakura_saito, weaver_loss


def test_the_loss_is_least_at_the_mean_of_exponential_power():
    power = torch.tensor(np.random.default_rng(0).exponential(2.0, 20000), dtype=torch.float32)
    scores = {mean: float(itakura_saito(torch.full_like(power, mean), power, torch.tensor(0.0))) for mean in (1, 2, 4)}
    assert min(scores, key=lambda mean: scores[mean]) == 2


def test_an_unpredicted_specular_lobe_weighs_by_its_decibels():
    mean = torch.ones(1)
    far = [float(itakura_saito(mean, torch.tensor([10.0**k]), torch.tensor(0.0))) for k in (3, 4, 5)]
    assert np.isclose(far[2] - far[1], far[1] - far[0], rtol=1e-3)
    assert np.isclose(far[1] - far[0], (STEEPEST - 1) * np.log(10), rtol=1e-3)


def test_the_true_echoes_cost_less_than_others():
    radar = MeanPower(AWR1843)

    def echoes(cross_section_m2: float, range_m: float, frames: tuple[int, ...]) -> MeanEchoes:
        return MeanEchoes(
            range_m=torch.full((*frames, 1), range_m), velocity_mps=torch.zeros(*frames, 1),
            direction=torch.zeros(*frames, 1, 2), cross_section_m2=torch.full((*frames, 1), cross_section_m2),
        )  # fmt: skip

    resting, moving = echoes(0.01, 3.0, (1,)), echoes(0.1, 2.0, (1, 2))
    still = radar.maps(points_of(resting, radar.response))
    person = radar.maps(points_of(moving, radar.response))
    names = ("range_doppler", "range_azimuth", "range_elevation")
    noise = dict(zip(names, radar.noise_maps(), strict=True))
    maps = type(still)(**{n: getattr(person, n) + getattr(still, n)[:, None] + noise[n] for n in names})
    targets = Targets(maps=maps, static=still)
    total = {
        name: float(sum(weaver_loss(radar, resting, one, targets).values()))
        for name, one in (("true", moving), ("fainter", echoes(0.01, 2.0, (1, 2))), ("off", echoes(0.1, 2.2, (1, 2))))
    }
    assert total["true"] < 1e-3 < min(total["fainter"], total["off"])
