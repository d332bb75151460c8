"""Points that a board, possibly tilted, reports of people in a random scene: ray-traced samples, clutter, firmware."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Complex

from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import PointCloud, PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.skin_scattering import LAMBERT, SkinEcho
from mmweaver.propagation.static_paths import AS_PUBLISHED
from mmweaver.recognition.random_scene import VariationSample, random_scene
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from
from mmweaver.signal.firmware import firmware_points
from mmweaver.signal.firmware_cfar import counts_per_db

BEHIND_M = 0.3  # minimum distance of a wall from the body
AT_M = 2.0  # range at which the level of diffuse clutter is specified
NEAREST_M = 0.3


@dataclass(frozen=True, kw_only=True)
class PointRadar:
    """A radar, the firmware that computes its points, and the number of skin points."""

    radar: RadarConfig
    firmware: FirmwareSettings
    skin_points: int


def observed_cloud(
    board: PointRadar, now: VariationSample, pose: PoseSequence | Sequence[PoseSequence], frames: int, seed: int
) -> PointCloud:
    """Points of one person, several, or an empty room, under sampled conditions.

    Args:
        board: Radar and firmware.
        now: Room, mount, noise and skin.
        pose: Motion in the radar's level axes; an empty tuple for an empty room.
        frames: Number of frames, from time 0.
        seed: Seed of noise, speckle and clutter.

    Returns:
        Points in the axes of the board, which is tilted down by `tilt_deg`.
    """
    radar = replace(
        board.radar,
        noise_figure_db=board.radar.noise_figure_db + now.noise_db,
        rx_gain_db=board.radar.rx_gain_db + now.gain_db,
        elevation_beamwidth_deg=now.elevation_beamwidth_deg,
    )
    wall_m = now.wall_m
    if wall_m is not None and isinstance(pose, PoseSequence):
        wall_m = max(wall_m, float(pose.joints_m[..., 1].max()) + BEHIND_M)
    looks = RadarPose(pitch_deg=-now.tilt_deg)
    scene = scene_seen_from(random_scene(floor_z_m=-now.radar_height_m, wall_y_m=wall_m, panels=now.panels), looks)
    people = (pose,) if isinstance(pose, PoseSequence) else tuple(pose)
    clutter = diffuse_clutter(radar, now.clutter_db, stream(seed, "diffuse clutter"))
    firmware = _less_sensitive(board.firmware, now.threshold_db, board.radar.num_antennas)
    adc = (
        Simulator(scene, radar, propagation=AS_PUBLISHED).run(
            people_seen_from(people, looks), num_frames=frames, seed=seed, num_points=board.skin_points, echo=_skin(now)
        )
    ).adc
    return firmware_points(replace(adc, samples=adc.samples + clutter), firmware)


def _less_sensitive(settings: FirmwareSettings, by_db: float, num_antennas: int) -> FirmwareSettings:
    """Settings with CFAR thresholds raised by `by_db`, in counts of the device."""
    counts = round(by_db * counts_per_db(settings.device, num_antennas))
    cfars = (settings.range_cfar, settings.doppler_cfar)
    high, low = (None if cfar is None else replace(cfar, threshold=cfar.threshold + counts) for cfar in cfars)
    return replace(settings, range_cfar=high, doppler_cfar=low)


def _skin(now: VariationSample) -> SkinEcho:
    """A lobe of cos^exponent with the total reflected power of Lambertian skin of the sampled albedo."""
    exponent = now.skin_exponent
    reflectivity = 8 / 3 * (exponent + 1) / exponent * LAMBERT.albedo * 10 ** (now.albedo_db / 10)
    return SkinEcho(
        reflectivity=reflectivity, slope=exponent**-0.5, albedo=0.0, arms_db=now.arms_db, legs_db=now.legs_db
    )


def diffuse_clutter(
    config: RadarConfig, level_db: float, rng: np.random.Generator
) -> Complex[np.ndarray, "tx rx sample"]:
    """ADC samples of static echoes at every range, identical in all chirps and frames, sqrt(mW).

    No real room is empty: they fill the zero-Doppler column and raise the noise estimate of its CFAR; of moving points
    only the slowest are masked. A stationary body interferes with them: where both share a range bin they add
    coherently, and the body's points come and go.

    `level_db` is their power in a range bin at 2 m relative to the thermal noise of one chirp in that bin. It falls as
    1/R^2 (the clutter area of a range bin grows as R^2, and each echo falls as 1/R^4). Phases of different antennas are
    independent, for the echoes come from all directions.
    """
    bins = config.num_samples
    range_m = np.arange(bins) * config.range_resolution_m
    share = np.where(range_m > NEAREST_M, AT_M / np.maximum(range_m, NEAREST_M), 0.0)
    samples = rng.standard_normal((config.num_tx, config.num_rx, bins, 2)).view(np.complex128)[..., 0] / np.sqrt(2)
    # noise of one sample has power p, and p / bins in each of the bins of a normalised spectrum
    amplitude = np.sqrt(config.noise_power_mw / bins * 10 ** (level_db / 10)) * share
    return (np.fft.ifft(samples * amplitude, axis=-1) * bins).astype(np.complex64)
