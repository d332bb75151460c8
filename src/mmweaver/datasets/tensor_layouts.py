"""Radar tensors in the layouts of other projects: HuPR, RF-Genesis, mmMesh, dynamic range-angle images (DRAI)."""

import json
from pathlib import Path

import numpy as np
from jaxtyping import Complex

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import joint
from mmweaver.datasets.formats import export_format
from mmweaver.io.peer_arrays import BOTH_ROWS, HUPR_FIRST_CHANNEL, HUPR_SHAPE, UPPER_TX
from mmweaver.io.stored_result import StoredResult
from mmweaver.signal.features import dynamic_range_angle

HUPR_JOINTS = (
    "right_hip",
    "right_knee",
    "right_ankle",
    "left_hip",
    "left_knee",
    "left_ankle",
    "neck",
    "head",
    "left_shoulder",
    "left_elbow",
    "left_wrist",
    "right_shoulder",
    "right_elbow",
    "right_wrist",
)


def write_hupr_pair(horizontal: StoredResult, vertical: StoredResult, out: Path) -> str:
    """Writes `hori/` and `vert/` of two radars of one scene, the second rolled by 90 degrees, as in `write_hupr`.

    The joints are in the horizontal radar's frame.

    Args:
        horizontal: Result of the first radar.
        vertical: Result of the second radar.
        out: The folder.

    Returns:
        Description of what was written.

    Raises:
        InputError: If the radars are not rolled relative to each other, or as in `write_hupr`.
    """
    rolls_deg = [float((one.meta.get("radar_pose") or {}).get("roll_deg", 0.0)) for one in (horizontal, vertical)]
    if abs(abs(rolls_deg[1] - rolls_deg[0]) - 90) > 20:
        raise InputError(
            f"HuPR's second radar is rolled by 90 degrees, this one by {rolls_deg[1] - rolls_deg[0]:g}; generate with"
            " --radar-pose 0,0,0,0,0 --radar-pose 0.1,0,0,0,0,90"
        )
    written = write_hupr(horizontal, out)
    _write_hupr_frames(vertical, out / "vert")
    return f"{written} by two radars"


@export_format("hupr", "HuPR's range-Doppler-angle arrays", needs_samples=True, write_pair=write_hupr_pair)
def write_hupr(result: StoredResult, out: Path) -> str:
    """Writes `hori/%09d.npy`, complex128 (16 Doppler, 64 range from far to near, 64 azimuth, 8 elevation), and joints.

    As in HuPR's preprocessing: no windows, mean over the loops removed, no TDM compensation, elevation FFT at azimuth
    channels 2 to 5 only, both angle axes reversed. `joints_m.npy` (frame, person, 14, 3) has HuPR's joints in the
    radar's frame, since HuPR's own labels are pixels of a camera that a result lacks.

    Reference: Lee et al., HuPR: A Benchmark for Human Pose Estimation Using Millimeter Wave Radar (WACV 2023).

    Raises:
        InputError: If the radar does not have 3 transmitters, 4 receivers, 64 range bins and at least 16 loops.
    """
    count = _write_hupr_frames(result, out / "hori")
    if result.poses:
        chosen = [joint(name) for name in HUPR_JOINTS]
        joints_m = np.stack([pose.joints_m[:, chosen] for pose in result.poses], axis=1)
        np.save(out / "joints_m.npy", joints_m.astype(np.float32))
        _write_json(
            out / "joints.json", {"joints": list(HUPR_JOINTS), "unit": "m", "axes": "frame, person, joint, xyz"}
        )
    return f"{count} frames of HuPR"


def _write_hupr_frames(result: StoredResult, folder: Path) -> int:
    """Writes the frames of one radar and returns their number."""
    adc = result.adc
    _check_hupr(adc.config)
    folder.mkdir(parents=True)
    for index, frame in enumerate(adc.samples):
        np.save(folder / f"{index:09d}.npy", hupr_frame(frame, adc.config))
    return len(adc.samples)


def hupr_frame(
    samples: Complex[Array, "loop tx rx sample"], config: RadarConfig
) -> Complex[Array, "doppler range azimuth elevation"]:
    """Converts one frame to HuPR's layout, see `write_hupr`.

    Args:
        samples: ADC samples, (loop, tx, rx, sample).
        config: The radar.

    Returns:
        Complex (16 Doppler, 64 range, 64 azimuth, 8 elevation).
    """
    kept, num_range = HUPR_SHAPE[:2]
    moving = samples - samples.mean(axis=0)
    spectrum = np.fft.fft(np.fft.fft(moving.astype(complex), axis=-1), axis=0)
    spectrum = spectrum[..., config.first_range_bin : config.first_range_bin + num_range][..., ::-1]
    channels = np.zeros((len(samples), num_range, HUPR_SHAPE[2], HUPR_SHAPE[3]), complex)
    for tx, first in enumerate(HUPR_FIRST_CHANNEL):
        for rx in range(config.num_rx):
            channels[:, :, first + rx, int(tx == UPPER_TX)] = spectrum[:, tx, rx]
    channels[:, :, BOTH_ROWS] = np.fft.fft(channels[:, :, BOTH_ROWS], axis=3)
    angles = np.fft.fftshift(np.fft.fft(channels, axis=2), axes=(2, 3))
    doppler = np.fft.fftshift(angles, axes=0)
    first = len(samples) // 2 - kept // 2
    return doppler[first : first + kept, :, ::-1, ::-1]


@export_format("rf_genesis", "RF-Genesis' radar frames", needs_samples=True)
def write_rf_genesis(result: StoredResult, out: Path) -> str:
    """Writes `radar_frames.npy`, complex128 (frame, tx, rx, chirp, sample), and `TI1843_config.json`.

    RF-Genesis fires all transmitters simultaneously; these samples keep the TDM timing of the radar. Transmitters, in
    the samples and in `tx_loc`, are in firing order, which is the order of RF-Genesis' own AWR1843.

    Reference: Chen and Zhang, RF Genesis (SenSys 2023), as of its public repository.
    """
    adc = result.adc
    np.save(out / "radar_frames.npy", _firing_order(adc).transpose(0, 2, 3, 1, 4).astype(np.complex128))
    _write_json(out / "TI1843_config.json", rf_genesis_settings(adc.config))
    return f"{len(adc.samples)} frames of RF-Genesis"


def rf_genesis_settings(config: RadarConfig) -> dict[str, object]:
    """Converts a radar to RF-Genesis' settings.

    Args:
        config: The radar.

    Returns:
        Settings in MHz/us, microseconds and ksps; antenna positions (x, z, y) in half wavelengths.
    """
    half_m = config.wavelength_m / 2
    places = {
        name: [[round(float(value) / half_m, 4) for value in (x, z, y)] for x, y, z in positions]
        for name, positions in (
            ("tx_loc", [config.tx_position_m[tx] for tx in config.tx_order]),
            ("rx_loc", config.rx_position_m),
        )
    }
    return {
        "c0": 299792458,
        "num_tx": config.num_tx,
        "num_rx": config.num_rx,
        "fc": config.start_frequency_hz,
        "slope": config.chirp_slope_hz_per_s / 1e12,
        "adc_samples": config.num_samples,
        "adc_start_time": config.adc_start_time_s * 1e6,
        "sample_rate": config.sample_rate_hz / 1e3,
        "idle_time": config.idle_time_s * 1e6,
        "ramp_end_time": config.ramp_end_time_s * 1e6,
        "chirp_per_frame": config.num_loops,
        "frame_per_second": 1 / config.frame_period_s,
        "num_doppler_bins": config.num_loops,
        "num_range_bins": config.num_samples,
        "num_angle_bins": 64,
        "power": config.tx_power_dbm,
        **places,
    }


@export_format("mmmesh", "mmMesh's point frames")
def write_mmmesh(result: StoredResult, out: Path) -> str:
    """Writes `points/%06d.npy`, float64 (point, 6): x, y, z in metres, velocity in m/s, energy, range in metres.

    The energy is the SNR as a power ratio. Raw samples, if present, are written to `adc/%06d.npy` as complex64 (tx, rx,
    loop, sample), transmitters in firing order.

    Reference: Xue et al., mmMesh (MobiSys 2021), as of its public repository.
    """
    points, folder = result.points, out / "points"
    folder.mkdir(parents=True)
    frames = len(result.cube.grid.frame_time_s)
    place = points.xyz_m.astype(np.float64)
    columns = (points.radial_velocity_mps, 10 ** (points.snr_db / 10), np.linalg.norm(place, axis=-1))
    rows = np.concatenate([place, np.stack(columns, axis=-1)], axis=-1)
    for index in range(frames):
        np.save(folder / f"{index:06d}.npy", rows[points.frame == index].astype(np.float64))
    if (result.folder / "adc_data.bin").is_file():
        (out / "adc").mkdir()
        adc = result.adc
        for index, frame in enumerate(_firing_order(adc)):
            np.save(out / "adc" / f"{index:06d}.npy", frame.transpose(1, 2, 0, 3))
    return f"{frames} frames of mmMesh"


@export_format("drai", "dynamic range-angle images, 32 x 32")
def write_drai(result: StoredResult, out: Path) -> str:
    """Writes `y_NAME_e0_u0_p0_s0.npy`: dynamic range-angle images, float32 (frame, 32 range, 32 azimuth), linear power.

    The mean chirp is removed; azimuths are equidistant from -60 to 60 degrees, ranges from the nearest to the farthest
    bin.
    """
    name = "".join(one if one.isalnum() else "-" for one in result.text)[:60].strip("-") or "recording"
    images = dynamic_range_angle(result.cube)
    np.save(out / f"y_{name}_e0_u0_p0_s0.npy", images)
    return f"{len(images)} dynamic range-angle images"


def _firing_order(adc: AdcCube) -> np.ndarray:
    """Samples (frame, loop, slot, rx, sample) in firing order; slots of a coded radar are already."""
    return adc.samples if adc.config.is_coded else adc.samples[:, :, list(adc.config.tx_order)]


def _check_hupr(config: RadarConfig) -> None:
    kept, num_range = HUPR_SHAPE[:2]
    if (config.num_tx, config.num_rx, config.num_range_bins) != (3, 4, num_range) or config.num_loops < kept:
        raise InputError(
            f"HuPR's arrays have 3 TX, 4 RX, {num_range} range bins and at least {kept} loops, radar {config.name!r}"
            f" has {config.num_tx}, {config.num_rx}, {config.num_range_bins} and {config.num_loops}; generate with"
            " --radar hupr"
        )


def _write_json(path: Path, content: dict[str, object]) -> None:
    path.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
