"""A real recording in, the same cube, points, files and pictures out as for a signal that was made."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.stages import Stages
from mmweaver.core.version import __version__
from mmweaver.dsp.cube import radar_cube
from mmweaver.dsp.detection import check_points, detect
from mmweaver.formats.dca1000 import read_bin
from mmweaver.formats.radar_file import load_firmware, load_radar
from mmweaver.formats.raw_npy import read_adc_npy
from mmweaver.pictures.view import View
from mmweaver.result_folder import META_VERSION, file_digest, radar_meta, save_results


@dataclass(frozen=True, kw_only=True)
class Recording:
    """A recording, processed."""

    adc: AdcCube
    cube: RadarCube
    points: PointCloud
    meta: dict[str, Any]
    stages: Stages

    def save(self, out: str | Path, *, overwrite: bool = False) -> dict[str, Any]:
        """Writes radar.npz, points.npz, radar.json, meta.json and the pictures into a folder; returns the meta."""
        view = View(title=f"{Path(self.meta['inputs']['recording']['path']).name}", cube=self.cube, points=self.points)
        return save_results(out, view, self.meta, overwrite=overwrite, stages=self.stages)


def process_recording(
    path: str | Path,
    radar: str | Path | RadarConfig,
    *,
    iq_order: str = "iq",
    tx_order: tuple[int, ...] | None = None,
    axes: str | None = None,
    points: str = "cfar",
    stages: Stages | None = None,
) -> Recording:
    """Reads raw ADC samples and takes them through range, Doppler, angle and CFAR.

    A `.npy` file needs `axes`, the names of its axes in their order, such as "frame,loop,tx,rx,sample"; any other file
    is read as a DCA1000 `.bin`, whose `iq_order` is "iq" or "qi" and whose `tx_order` says which transmitter was
    first (default: the radar's). `points` chooses the point cloud: "cfar", or "firmware" as TI's demo would report it
    with the settings of the radar's .cfg. Raises InputError for anything that cannot be read so.
    """
    path, stages = Path(path), stages or Stages()
    config = radar if isinstance(radar, RadarConfig) else load_radar(str(radar))
    if tx_order is not None:
        config = replace(config, tx_order=tx_order)
    check_points(points, config)
    firmware = None
    if points == "firmware":
        firmware = FirmwareSettings() if isinstance(radar, RadarConfig) else load_firmware(str(radar))
    with stages("read the recording"):
        if path.suffix == ".npy":
            if axes is None:
                raise InputError(f"{path}: say which axis is which, for example --axes frame,loop,tx,rx,sample")
            adc = read_adc_npy(path, config, axes)
        else:
            adc = read_bin(path, config, iq_order=iq_order)
        digest = file_digest(path)
    with stages("range, Doppler, antennas"):
        cube = radar_cube(adc)
    with stages("point cloud"):
        cloud = detect(cube, adc, points, firmware)
    meta = {
        "schema_version": META_VERSION,
        "made_by": "mmweaver process",
        "version": __version__,
        "frames": len(cube.grid.frame_time_s),
        "iq_order": None if path.suffix == ".npy" else iq_order,
        "tx_order": config.tx_order,
        "axes": axes,
        "points": points,
        "firmware": firmware,
        **radar_meta(adc.config),
        "inputs": {"recording": digest},
        "assumed": [f"frames follow each other every {adc.config.frame_period_s * 1e3:g} ms, as the radar says"],
    }
    return Recording(adc=adc, cube=cube, points=cloud, meta=meta, stages=stages)
