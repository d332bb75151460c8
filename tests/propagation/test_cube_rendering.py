"""The two renderers take the same paths: samples through the range and Doppler transforms, or straight to cells."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843, HUPR
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.transmit_code import tx_code_of
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.paths import ApparentPoint, FrameClock, Interaction, Paths, StaticPaths
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.cube import cube_values
from tests.physics.test_reference_sum import direct_paths, moving_points

BPM = replace(
    AWR1843, name="bpm", num_loops=16, tx_order=(0, 1, 2),
    tx_code=tx_code_of(np.array([[1, 0, 1], [0, 1, 0], [1, 0, -1]])),
)  # fmt: skip


def sampled(config: RadarConfig, speed_mps: float, reciprocal: float, frames: int = 2, count: int = 40) -> Paths:
    """Paths inside the range window, this share over a wall on one way, for every segment of some frames."""
    rng = np.random.default_rng(4)
    shape = (frames * len(AdcSynthesis(config).clock.segments), count)
    azimuth, elevation = rng.uniform(-0.7, 0.7, shape), rng.uniform(-0.3, 0.3, shape)
    distance = rng.uniform(config.range_m[6], config.range_m[-6], shape)
    motion = np.zeros((*shape, 3, 3))
    motion[..., 0, :] = np.stack(
        [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1
    ) * distance[..., None]  # fmt: skip
    motion[..., 1, :] = rng.uniform(-speed_mps, speed_mps, (*shape, 3))
    motion[..., 2, :] = rng.uniform(-5 * speed_mps, 5 * speed_mps, (*shape, 3))
    is_reciprocal = rng.random(shape) < reciprocal
    image = np.where(is_reciprocal[..., None, None], motion * np.array([-1.0, 1.0, 1.0]), motion)
    amplitude = torch.from_numpy(rng.normal(size=shape) + 1j * rng.normal(size=shape))
    direct = Paths.direct(amplitude, ApparentPoint.of(motion))
    return replace(direct, arrival=ApparentPoint.of(image), is_reciprocal=torch.from_numpy(is_reciprocal))


def error_db(got: torch.Tensor, wanted: torch.Tensor) -> float:
    return 20 * float(torch.log10((got - wanted).norm() / wanted.norm()))


@pytest.mark.parametrize("config", [AWR1843, HUPR], ids=["one segment", "seven segments"])
@pytest.mark.parametrize(("speed_mps", "bound_db"), [(0.0, -37.0), (0.7, -36.0), (2.0, -30.0)])
def test_both_renderers_make_the_same_cube_of_moving_paths(config: RadarConfig, speed_mps: float, bound_db: float):
    paths = sampled(config, speed_mps, 0.0)
    wanted = cube_values(AdcSynthesis(config, is_faded=True).moving(paths), config)
    assert error_db(CubeRenderer(config).moving(paths), wanted) < bound_db


@pytest.mark.parametrize("renderer", ["cube", "samples"])
def test_an_amplitude_that_differs_between_segments_leaves_no_spurs(renderer: str):
    """Steps of a quarter of the amplitude within a frame would show at all velocities."""
    clock = FrameClock(HUPR)
    still = sampled(HUPR, 0.0, 0.0)[: len(clock.segments), :1]
    still = still.map(lambda tensor: tensor[:1].repeat(len(clock.segments), *[1] * (tensor.ndim - 1)))
    level = torch.tensor([1.0, 0.75, 1.0, 0.75, 1.0, 0.75, 1.0])
    paths = replace(still, amplitude=still.amplitude * level[:, None])

    def spurs_db(samples: AdcSynthesis | None) -> float:
        values = CubeRenderer(HUPR).moving(paths) if samples is None else cube_values(samples.moving(paths), HUPR)
        power = values.abs().square().sum(dim=(0, 1, 3))  # by velocity, 0 in the middle
        fast = torch.cat([power[: len(power) // 4], power[-len(power) // 4 :]])
        return 10 * float(torch.log10(fast.max() / power.max()))

    assert spurs_db(None if renderer == "cube" else AdcSynthesis(HUPR, is_faded=True)) < -70
    assert spurs_db(AdcSynthesis(HUPR)) > -60


@pytest.mark.parametrize(
    ("speed_mps", "acceleration_mps2", "bound_db"), [(0.0, 0.0, -60), (0.5, 5.0, -53), (3.0, 30.0, -39)]
)
def test_the_cube_against_the_exact_sum(speed_mps: float, acceleration_mps2: float, bound_db: float):
    position, amplitude = moving_points(40, speed_mps, acceleration_mps2)
    paths = direct_paths(position, amplitude, AdcSynthesis(AWR1843))
    exact = torch.from_numpy(exact_frame(position, amplitude, AWR1843).astype(np.complex64))[None]
    assert error_db(CubeRenderer(AWR1843).moving(paths), cube_values(exact, AWR1843)) < bound_db


def test_both_renderers_make_the_same_cube_of_static_paths():
    rng = np.random.default_rng(5)
    place = rng.uniform((-1.5, 1.2, -0.8), (1.5, 2.2, 0.8), (400, 3))
    scattered = scattered_paths(place, rng.normal(size=400) + 0j, Interaction.DIFFUSE, AWR1843)
    image_m = np.asarray(AWR1843.tx_position_m) * [1, -1, 1] + [0.3, 3.4, 0.2]  # the array in a wall
    length_m = np.linalg.norm(image_m[:, None] - np.asarray(AWR1843.rx_position_m), axis=-1)[None]
    vertex = np.array([[0.15, 1.7, 0.1]])
    specular = StaticPaths.of(np.array([3.0 + 0j]), length_m, vertex, vertex, Interaction.SPECULAR)
    paths = StaticPaths.cat([scattered, specular])
    loops = AdcSynthesis(AWR1843).static(paths).expand(1, AWR1843.num_loops, -1, -1, -1)
    wanted = cube_values(loops.contiguous(), AWR1843)
    renderer = CubeRenderer(AWR1843)
    got = torch.zeros_like(wanted)
    renderer.add_static(got, renderer.static(paths).layer())
    assert error_db(got, wanted) < -38
    each = renderer.static(paths).each()
    assert error_db(each.sum(dim=1).reshape(64, 12), renderer.static(paths).layer()) < -100


def test_both_renderers_take_simultaneous_transmitters():
    """BPM-MIMO: moving paths as samples and as cells, against the exact sum; static ones in both."""
    position, amplitude = moving_points(40, 0.5, 5.0)
    paths = direct_paths(position, amplitude, AdcSynthesis(BPM))
    exact = torch.from_numpy(exact_frame(position, amplitude, BPM).astype(np.complex64))[None]
    assert error_db(AdcSynthesis(BPM).moving(paths), exact) < -34
    assert error_db(CubeRenderer(BPM).moving(paths), cube_values(exact, BPM)) < -55
    rng = np.random.default_rng(1)
    place = rng.uniform((-1.5, 1.0, -0.5), (1.5, 3.0, 0.5), (50, 3))
    static = scattered_paths(place, rng.normal(size=50) + 0j, Interaction.DIFFUSE, BPM)
    loops = AdcSynthesis(BPM).static(static).expand(1, BPM.num_loops, -1, -1, -1).contiguous()
    renderer = CubeRenderer(BPM)
    values = torch.zeros((1, BPM.num_range_bins, BPM.num_loops, BPM.num_antennas), dtype=torch.complex64)
    renderer.add_static(values, renderer.static(static).layer())
    assert error_db(values, cube_values(loops, BPM)) < -38
