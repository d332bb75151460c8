"""A recording in; the same cube, points, files and pictures out as for a generated signal."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.board import Board, read_board
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.shapes import Array, PerFrame, PerIndex
from mmweaver.core.stages import Stages
from mmweaver.core.version import __version__
from mmweaver.dsp.cube import remove_static
from mmweaver.dsp.detection import check_points, detect, needs_adc
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.previews import PREVIEWS
from mmweaver.figures.recording_pages import draw_micro_doppler, draw_people, draw_slow_time
from mmweaver.formats.dca_packets import PacketCapture
from mmweaver.formats.npz_files import write_npz
from mmweaver.formats.radar_file import load_firmware
from mmweaver.formats.result_folder import META_VERSION, file_digest, radar_meta, save_results
from mmweaver.recordings.analysis import RecordingAnalysis, analyse_recording
from mmweaver.recordings.plausibility import implausible
from mmweaver.recordings.read_recording import Recording, as_config, read_recording, without_board
from mmweaver.scene.photo.capture_photo import photo_folder, photo_times_s


@dataclass(frozen=True, kw_only=True)
class ProcessedRecording:
    """A recording's cube and point cloud, and what meta.json says of them."""

    adc: AdcCube | None  # None where the recording holds a cube and no samples
    cube: RadarCube
    points: PointCloud
    meta: dict[str, Any]
    stages: Stages
    analysis: RecordingAnalysis | None = None

    def save(
        self, out: str | Path, *, overwrite: bool = False, extra: dict[str, str] | None = None, pictures: bool = True
    ) -> dict[str, Any]:
        """Writes radar.npz, points.npz, radar.json, meta.json and the pictures into a folder; returns the meta.

        `extra`: text files to add, by name. Without `pictures` the previews are left out.
        """
        title = Path(self.meta["inputs"]["recording"]["path"]).name
        view = FigureData(title=title, cube=self.cube, points=self.points)
        return save_results(
            out, view, self.meta, overwrite=overwrite, stages=self.stages, extra=extra,
            pictures=PREVIEWS if pictures else None, more=partial(self._write_analysis, title, pictures),
        )  # fmt: skip

    def _write_analysis(self, title: str, pictures: bool, folder: Path) -> None:
        """analysis.npz and its pages."""
        found = self.analysis
        if found is None:
            return
        if arrays := found.arrays():
            write_npz(folder / "analysis.npz", **arrays)
        if not pictures:
            return
        if found.cells and found.slow_doppler is not None and found.slow_velocity_mps is not None:
            signs = found.vital_signs
            rates = {} if signs is None else {"breathing": signs.breathing, "heart": signs.heart}
            draw_slow_time(
                folder / "slow_time.png", title, self.cube, found.slow_doppler, found.slow_velocity_mps, found.cells,
                rates,
            )  # fmt: skip
        if found.micro_doppler is not None:
            draw_micro_doppler(folder / "micro_doppler.png", title, found.micro_doppler, self.cube.scale)
        if found.people:
            draw_people(folder / "people.png", title, found.people, float(self.cube.grid.range_m[-1]))


def process_recording(
    path: str | Path,
    radar: str | Path | RadarConfig | None = None,
    *,
    layout: str | None = None,
    axes: str | None = None,
    iq_order: str | None = None,
    tx_order: tuple[int, ...] | None = None,
    range_m: tuple[float, float] | None = None,
    range_bins: tuple[int, int] | None = None,
    points: str = "cfar",
    static_removal: str = "none",
    board: str | Path | Board | None = None,
    analyse: bool = True,
    strict: bool = False,
    stages: Stages | None = None,
) -> ProcessedRecording:
    """Reads a recording and takes it through range, Doppler, angle and CFAR.

    `board`: whose errors are taken away first, a board.json (`mmweaver calibrate`) or a Board.
    `path`, `radar`, `layout`, `axes`, `iq_order`, `tx_order`, `range_m` and `range_bins` as in `read_recording`.
    `static_removal` (see `dsp.cube.remove_static`) takes static clutter away from the cube and its points; `analyse`
    looks for slow movement, vital signs, micro-Doppler and people. The meta warns of samples that do not fit the
    settings; if `strict` they are refused (`recordings.plausibility`). `points` chooses the point cloud: "cfar", or
    "firmware" as TI's demo would report it with the settings of the radar's .cfg. Lost packets of a capture folder are
    zeros and counted; where it has a RealSense too, the meta says which of its photos is nearest in time to each radar
    frame, by the recorder's clock. Raises InputError for anything that cannot be read so.
    """
    stages = stages or Stages()
    made_by = read_board(board) if isinstance(board, str | Path) else board
    if radar is not None:  # a point cloud that this radar cannot have is refused before its samples are read
        check_points(points, as_config(radar))
        _firmware(points, None if isinstance(radar, RadarConfig) else str(radar))
    with stages("read the recording"):
        recording = read_recording(
            path, radar, layout=layout, axes=axes, iq_order=iq_order, tx_order=tx_order, range_m=range_m,
            range_bins=range_bins,
        )  # fmt: skip
        if made_by is not None:
            recording = without_board(recording, made_by)
        check_points(points, recording.config)
        if recording.adc is None and points != "firmware" and needs_adc(points):
            raise InputError(f"{path} holds a cube, but --points {points} needs raw samples; give the raw recording")
        firmware = _firmware(points, recording.radar_source)
        inputs = {name: _digest(file) for name, file in recording.files.items()}
        of_packets = {} if recording.packets is None else _packets_meta(recording.path, recording.packets)
    with stages("range, Doppler, antennas"):
        whole = recording.cube
        cube = remove_static(whole, static_removal)
        warnings = _warnings(recording, strict)
    with stages("point cloud"):
        cloud = detect(cube, recording.adc if static_removal == "none" else None, points, firmware)
    with stages("movement, people"):
        analysis = analyse_recording(whole, recording.adc) if analyse else None
    meta = {
        "schema_version": META_VERSION,
        "made_by": "mmweaver process",
        "version": __version__,
        "frames": len(cube.grid.frame_time_s),
        "iq_order": recording.iq_order,
        "tx_order": cube.config.tx_order,
        "axes": recording.axes,
        "points": points,
        "static_removal": static_removal,
        "calibration": _calibration_meta(recording),
        "board": _board_meta(recording),
        "warnings": warnings,
        "analysis": None if analysis is None else analysis.meta(),
        "firmware": firmware,
        **radar_meta(cube.config),
        "inputs": inputs,
        **of_packets,
        "assumed": [*_assumptions(recording), *recording.config.notes],
    }
    return ProcessedRecording(adc=recording.adc, cube=cube, points=cloud, meta=meta, stages=stages, analysis=analysis)


def _calibration_meta(recording: Recording) -> dict[str, Any] | None:
    """What was compensated of the board's channel errors."""
    own = recording.calibration
    if own is None:
        return None
    return {"range_bias_m": own.range_bias_m, "factor_abs": np.abs(own.factors), "factor_rad": np.angle(own.factors)}


def _board_meta(recording: Recording) -> dict[str, Any] | None:
    """The board whose errors were taken away, which of them were and were not."""
    own = recording.board
    if own is None:
        return None
    return {**own.board.meta(), "corrected": own.corrected, "left_in": own.left_in}


def _warnings(recording: Recording, strict: bool) -> list[str]:
    if recording.adc is None:
        return []
    file = recording.files["recording"] if recording.axes is None else None
    times_s = None if recording.packets is None else recording.packets.frame_time_s
    found = implausible(recording.adc, recording.cube, file, iq_order=recording.iq_order, frame_time_s=times_s)
    if found and strict:
        raise InputError(f"{recording.path}: {'; '.join(found)} (strict)")
    return found


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


def _firmware(points: str, radar_source: str | None) -> FirmwareSettings | None:
    """The settings of TI's point cloud of a preset or file, where they are needed. Raises InputError."""
    if points != "firmware":
        return None
    return FirmwareSettings() if radar_source is None else load_firmware(radar_source)


def _digest(path: Path) -> dict[str, str]:
    return {"path": str(path)} if path.is_dir() else file_digest(path)


def _packets_meta(folder: Path, packets: PacketCapture) -> dict[str, Any]:
    """Packet counts, arrival times of the frames and the photos nearest to them."""
    meta = {"packets": packets.report, "frame_clock_s": np.round(packets.frame_time_s, 6)}
    camera = photo_folder(folder)
    if camera is None:
        return meta
    index, late_s = nearest_photos(packets.frame_time_s, photo_times_s(camera))
    return meta | {"photo_of_frame": index, "photo_minus_frame_s": np.round(late_s, 4)}


def _assumptions(recording: Recording) -> list[str]:
    if recording.stored_cube is not None:
        return []
    every = f"frames follow each other every {recording.config.frame_period_s * 1e3:g} ms, as"
    if recording.packets is None:
        return [f"{every} the radar's configuration says"]
    report = recording.packets.report
    sentences = [f"{every} the radar's configuration says; frame_clock_s holds when their first packets came"]
    if report.lost_bytes:
        sentences.append(f"{report.lost} packets were lost: {report.lost_bytes} bytes of samples are zero")
    if report.bytes_after_last_frame:
        sentences.append(f"{report.bytes_after_last_frame} bytes of an unfinished last frame were left out")
    return sentences
