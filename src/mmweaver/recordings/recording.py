"""A real recording in, the same cube, points, files and pictures out as for a signal that was made."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.shapes import Array, PerFrame, PerIndex
from mmweaver.core.stages import Stages
from mmweaver.core.version import __version__
from mmweaver.dsp.cube import radar_cube, tdm_compensation
from mmweaver.dsp.detection import check_points, detect
from mmweaver.figures.figure_data import FigureData
from mmweaver.formats.capture_std import PACKETS, RADAR, read_radar_capture
from mmweaver.formats.dca1000 import read_bin
from mmweaver.formats.dca_packets import PacketReport
from mmweaver.formats.npz_files import read_radar_npz
from mmweaver.formats.peer_arrays import LAYOUTS, read_hupr, read_mmmesh, read_rf_genesis, recognised
from mmweaver.formats.radar_file import load_firmware, load_radar
from mmweaver.formats.raw_npy import read_adc_npy
from mmweaver.result_folder import META_VERSION, file_digest, radar_meta, save_results
from mmweaver.scene.photo.capture_photo import photo_folder, photo_times_s


@dataclass(frozen=True, kw_only=True)
class Recording:
    """A recording, processed."""

    adc: AdcCube
    cube: RadarCube
    points: PointCloud
    meta: dict[str, Any]
    stages: Stages

    def save(self, out: str | Path, *, overwrite: bool = False, extra: dict[str, str] | None = None) -> dict[str, Any]:
        """Writes radar.npz, points.npz, radar.json, meta.json and the pictures into a folder; returns the meta.

        `extra`: text files to add, by name.
        """
        view = FigureData(
            title=f"{Path(self.meta['inputs']['recording']['path']).name}", cube=self.cube, points=self.points
        )
        return save_results(out, view, self.meta, overwrite=overwrite, stages=self.stages, extra=extra)


def process_recording(
    path: str | Path,
    radar: str | Path | RadarConfig | None,
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
    if not path.exists():
        raise InputError(f"{path} does not exist; give a recording or a capture folder")
    if radar is None:
        raise InputError(f"{path}: which radar recorded it? give --radar; only a capture folder brings its own")
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


def process_capture(path: str | Path, *, points: str = "cfar", stages: Stages | None = None) -> Recording:
    """The radar of a capture folder (mmwave-capture-std: radar.cfg, dca.pcap) through the same processing.

    Lost packets are zeros and counted. Where the folder has a RealSense too, the meta says which of its photos is the
    nearest in time to each radar frame, by the recorder's clock. Raises InputError for anything that cannot be read so.
    """
    stages = stages or Stages()
    with stages("read the recording"):
        capture = read_radar_capture(path)
        check_points(points, capture.config)
        firmware = load_firmware(str(capture.folder / RADAR)) if points == "firmware" else None
        digests = {"recording": file_digest(capture.folder / PACKETS), "radar": file_digest(capture.folder / RADAR)}
        packets = capture.packets
        photos = _photos(capture.folder, packets.frame_time_s)
    with stages("range, Doppler, antennas"):
        cube = radar_cube(packets.adc)
    with stages("point cloud"):
        cloud = detect(cube, packets.adc, points, firmware)
    meta = {
        "schema_version": META_VERSION,
        "made_by": "mmweaver process",
        "version": __version__,
        "frames": len(cube.grid.frame_time_s),
        "iq_order": capture.iq_order,
        "tx_order": capture.config.tx_order,
        "points": points,
        "firmware": firmware,
        **radar_meta(packets.adc.config),
        "inputs": digests,
        "packets": packets.report,
        "frame_clock_s": np.round(packets.frame_time_s, 6),
        **photos,
        "assumed": _capture_assumptions(packets.report, packets.adc.config),
    }
    return Recording(adc=packets.adc, cube=cube, points=cloud, meta=meta, stages=stages)


def nearest_photos(frame_time_s: PerFrame, photo_time_s: Float[Array, " photo"]) -> tuple[PerIndex, PerFrame]:
    """For each radar frame the index of the photo nearest in time, and photo minus frame in seconds.

    >>> index, late_s = nearest_photos(np.array([0.0, 0.1, 0.2]), np.array([0.02, 0.09, 0.15]))
    >>> index.tolist(), np.round(late_s, 2).tolist()
    ([0, 1, 2], [0.02, -0.01, -0.05])
    """
    order = np.argsort(photo_time_s)
    rising = photo_time_s[order]
    after = np.clip(np.searchsorted(rising, frame_time_s), 0, len(rising) - 1)
    before = np.maximum(after - 1, 0)
    is_before = np.abs(rising[before] - frame_time_s) <= np.abs(rising[after] - frame_time_s)
    index = order[np.where(is_before, before, after)]
    return index, photo_time_s[index] - frame_time_s


def _photos(folder: Path, frame_time_s: PerFrame) -> dict[str, Any]:
    camera = photo_folder(folder)
    if camera is None:
        return {}
    index, late_s = nearest_photos(frame_time_s, photo_times_s(camera))
    return {"photo_of_frame": index, "photo_minus_frame_s": np.round(late_s, 4)}


def _capture_assumptions(report: PacketReport, config: RadarConfig) -> list[str]:
    sentences = [
        f"frames follow each other every {config.frame_period_s * 1e3:g} ms, as radar.cfg says; frame_clock_s holds"
        " when their first packets came"
    ]
    if report.lost_bytes:
        sentences.append(f"{report.lost} packets were lost: {report.lost_bytes} bytes of samples are zero")
    if report.bytes_after_last_frame:
        sentences.append(f"{report.bytes_after_last_frame} bytes of an unfinished last frame were left out")
    return sentences


def read_any_cube(
    path: str | Path,
    radar: str | Path | RadarConfig | None = None,
    *,
    layout: str | None = None,
    axes: str | None = None,
    iq_order: str = "iq",
    tx_order: tuple[int, ...] | None = None,
) -> RadarCube:
    """The cube of a recording in any of the files that are understood.

    A radar.npz (its radar.json beside it, unless `radar` is given); an adc_data.bin; a .npy of ADC samples with its
    `axes`, or a .npy in another project's `layout`: "hupr" (also a folder of its frames; recognised by its shape),
    "mmmesh" or "rf_genesis", whose radar is the preset of that name unless one is given. Raises InputError where the
    file cannot be read so.
    """
    path = Path(path)
    if layout is not None and (layout not in LAYOUTS or axes is not None):
        raise InputError(f"give a layout ({', '.join(LAYOUTS)}) or axes, not both; got {layout!r} and {axes!r}")
    is_array = path.suffix == ".npy" or path.is_dir() or layout is not None
    if is_array and axes is None:
        layout = layout or recognised(path)
    config = radar if isinstance(radar, RadarConfig) else load_radar(str(radar)) if radar is not None else None
    if path.suffix == ".npz":
        return read_radar_npz(path, config)
    config = config or (load_radar(layout) if layout is not None else None)
    if config is None:
        raise InputError(f"{path}: say which radar recorded it, for example --radar awr1843")
    if tx_order is not None:
        config = replace(config, tx_order=tx_order)
    if layout is not None:
        return _peer_cube(path, config, layout)
    return radar_cube(read_adc_npy(path, config, axes) if axes else read_bin(path, config, iq_order=iq_order))


def _peer_cube(path: Path, config: RadarConfig, layout: str) -> RadarCube:
    if layout == "hupr":
        cube = read_hupr(path, config)
        return replace(cube, values=cube.values * tdm_compensation(config))
    if layout == "mmmesh":
        return radar_cube(read_mmmesh(path, config))
    return radar_cube(read_rf_genesis(path, config), compensate_tdm=False)
