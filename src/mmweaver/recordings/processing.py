"""Processing of recordings to the same cube, points, files and pictures as generated signals."""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board, read_board
from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.stages import Stages
from mmweaver.io.dca_packets import PacketCapture
from mmweaver.io.npz_files import write_npz
from mmweaver.io.radar_file import announced_frames, load_firmware
from mmweaver.io.result_folder import META_VERSION, file_digest, radar_meta, save_results
from mmweaver.recordings.analysis import RecordingAnalysis, analyse_recording
from mmweaver.recordings.dca_bin import loss_sentences
from mmweaver.recordings.long_recording import Blocks, LongRecording, Progress, block_frames, is_long
from mmweaver.recordings.plausibility import implausible
from mmweaver.recordings.read_recording import Recording, as_config, read_recording, without_board
from mmweaver.recordings.recording_pieces import RecordingPieces
from mmweaver.scene.photo.capture_photo import photo_folder, photo_times_s
from mmweaver.signal.cube import remove_static
from mmweaver.signal.detection import check_points, detect, needs_adc, substitutes
from mmweaver.signal.windows import MIN_HANN_LOOPS
from mmweaver.viz.feature_page import draw_micro_doppler, draw_people, draw_slow_time
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.preview import PREVIEWS


@dataclass(frozen=True, kw_only=True)
class ProcessedRecording:
    """Cube, point cloud and analysis of a recording, with the content of meta.json."""

    adc: AdcCube | None  # None if the recording contains a cube only
    cube: RadarCube
    points: PointCloud
    meta: dict[str, Any]
    stages: Stages
    analysis: RecordingAnalysis | None = None
    resumed: int = 0  # blocks that an interrupted run had finished

    def save(
        self, out: str | Path, *, overwrite: bool = False, extra: dict[str, str] | None = None, pictures: bool = True
    ) -> dict[str, Any]:
        """Writes radar.npz, points.npz, radar.json, meta.json and the pictures into a folder.

        Args:
            out: The folder.
            overwrite: Whether it may contain files. Default: False.
            extra: Further text files by name. Default: none.
            pictures: Whether to draw previews. Default: True.

        Returns:
            Content of meta.json.

        Raises:
            InputError: If the folder contains files without `overwrite`, or cannot be written.
        """
        title = Path(self.meta["inputs"]["recording"]["path"]).name
        view = FigureData(title=title, cube=self.cube, points=self.points)
        return save_results(
            out,
            view,
            self.meta,
            overwrite=overwrite,
            stages=self.stages,
            extra=extra,
            pictures=PREVIEWS if pictures else None,
            more=partial(self._write_analysis, title, pictures),
        )

    def _write_analysis(self, title: str, pictures: bool, folder: Path) -> None:
        """Writes analysis.npz and its pictures."""
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
            slow = found.slow_doppler, found.slow_velocity_mps
            draw_slow_time(folder / "slow_time.png", title, self.cube, slow, found.cells, rates)
        if found.micro_doppler is not None:
            draw_micro_doppler(folder / "micro_doppler.png", title, found.micro_doppler, self.cube.scale)
        if found.people:
            draw_people(folder / "people.png", title, found.people, float(self.cube.grid.range_m[-1]))


def process_recording(
    path: str | Path,
    radar: str | Path | RadarConfig | None = None,
    *,
    points: str = "cfar",
    static_removal: str = "none",
    board: str | Path | Board | None = None,
    analyse: bool = True,
    strict: bool = False,
    stages: Stages | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
    **reading: Any,
) -> ProcessedRecording:
    """Reads a recording and computes its range-Doppler cube and point cloud.

    Args:
        path: The recording, as in `read_recording`.
        radar: Its radar, as in `read_recording`.
        points: Detector: "cfar", or "firmware" for the points that TI's demo would report with the settings of the
            radar's .cfg. Default: "cfar".
        static_removal: Method of static clutter removal, see `signal.cube.remove_static`. Default: "none".
        board: Board whose errors are removed first: a board.json (`mmweaver calibrate`) or a Board. Default: none.
        analyse: Whether to estimate slow movement, vital signs, micro-Doppler and people. Default: True.
        strict: Whether samples that disagree with the settings (`recordings.plausibility`) are refused instead of
            reported in the meta. Default: False.
        stages: Timer of the stages. Default: a new one.
        work: Folder for the blocks of a long recording, which then takes bounded memory and continues after an
            interruption; the caller deletes it once the result is saved. Default: everything in memory.
        progress: Called with frames done and all frames of a long recording.
        **reading: `range_m`, `range_bins`, `layout`, `axes`, `iq_order` and `tx_order` of `read_recording`.

    Returns:
        Cube, points, analysis and meta. Lost packets of a capture folder are zero-filled and counted. If it also
        contains RealSense photos, the meta lists the one nearest in time to each radar frame, by the recorder's clock.

    Raises:
        InputError: If the recording cannot be read with these settings.
    """
    stages = stages or Stages()
    made_by = read_board(board) if isinstance(board, str | Path) else board
    if radar is not None:  # refuse an unsupported detector before reading samples
        check_points(points, as_config(radar))
        _firmware(points, None if isinstance(radar, RadarConfig) else str(radar))
    steps = _Steps(points=points, static_removal=static_removal, board=made_by, strict=strict, analyse=analyse)
    if work is not None:
        pieces = RecordingPieces(path, radar, **reading)
        if pieces.first is not None and pieces.first.adc is not None and steps.is_by_frame(pieces):
            return _process_long(pieces, steps, stages, work, progress or (lambda done, total: None), reading)
    with stages("read the recording"):
        recording = steps.corrected(read_recording(path, radar, **reading))
    with stages("range, Doppler, antennas"):
        whole = recording.cube
        cube = remove_static(whole, static_removal)
        warnings = _warnings(recording, strict)
    with stages("point cloud"):
        cloud = steps.points_of(recording, cube)
    with stages("movement, people"):
        analysis = analyse_recording(whole, recording.adc) if analyse else None
    meta = _meta(recording, cube, steps, warnings, analysis)
    return ProcessedRecording(adc=recording.adc, cube=cube, points=cloud, meta=meta, stages=stages, analysis=analysis)


@dataclass(frozen=True, kw_only=True)
class _Steps:
    """Choices of a processing."""

    points: str
    static_removal: str
    board: Board | None
    strict: bool
    analyse: bool

    def corrected(self, found: Recording) -> Recording:
        """The recording without the errors of its board. Raises InputError if the detector does not suit it."""
        found = found if self.board is None else without_board(found, self.board)
        check_points(self.points, found.config)
        if found.adc is None and self.points != "firmware" and needs_adc(self.points):
            raise InputError(
                f"{found.path} holds a cube, but --points {self.points} needs raw samples; give the raw recording"
            )
        return found

    def points_of(self, found: Recording, cube: RadarCube) -> PointCloud:
        """Points of a cube, with its samples where static clutter stays in."""
        firmware = _firmware(self.points, found.radar_source)
        return detect(cube, found.adc if self.static_removal == "none" else None, self.points, firmware)

    def finish(self, found: Recording) -> tuple[RadarCube, PointCloud]:
        """Cube and points of a block."""
        cube = remove_static(found.cube, self.static_removal)
        return cube, self.points_of(found, cube)

    def is_by_frame(self, pieces: RecordingPieces) -> bool:
        """Whether a recording is long, and each frame of its result follows from that frame alone."""
        assert pieces.first is not None
        config = pieces.first.config
        own = self.static_removal in ("none", "mean_chirp") or config.num_loops >= MIN_HANN_LOOPS
        return self.static_removal != "mean_frame" and own and is_long(config, pieces.num_frames)


def _process_long(
    pieces: RecordingPieces,
    steps: _Steps,
    stages: Stages,
    work: Path,
    progress: Progress,
    reading: dict[str, Any],
) -> ProcessedRecording:
    """Processes a recording block by block, see `recordings.long_recording`."""
    assert pieces.first is not None
    first = steps.corrected(pieces.recording(slice(0, block_frames(pieces.first.config))))
    files = {name: [str(one), one.stat().st_mtime_ns, one.stat().st_size] for name, one in first.files.items()}
    identity = {"files": files, "radar": first.config.to_json(), "reading": reading, "steps": str(steps)}
    blocks = Blocks(
        read=lambda frames: steps.corrected(pieces.recording(frames)),
        finish=steps.finish,
        num_frames=pieces.num_frames,
        analyse=steps.analyse,
    )
    with stages("range, Doppler, points"):
        warnings = _warnings(replace(first, lost_share=None), steps.strict)
        long = LongRecording(work, blocks, identity)
        long.run(progress)
        cube, cloud = long.cube(first.cube), long.points()
        assert cloud is not None
    lost, clock_s = long.column("lost_share"), long.column("frame_clock_s")
    if lost is not None:
        warnings = _refused_if(steps.strict, [*warnings, *loss_sentences(lost)], first.path)
    packets = None if first.packets is None else replace(first.packets, frame_time_s=clock_s)
    with stages("movement, people"):
        analysis = long.analysis(cube) if steps.analyse else None
    whole = replace(first, lost_share=lost, packets=packets)
    meta = _meta(whole, cube, steps, warnings, analysis)
    return ProcessedRecording(
        adc=None, cube=cube, points=cloud, meta=meta, stages=stages, analysis=analysis, resumed=long.resumed_from
    )


def _meta(
    recording: Recording,
    cube: RadarCube,
    steps: _Steps,
    warnings: list[str],
    analysis: RecordingAnalysis | None,
) -> dict[str, Any]:
    """Content of meta.json."""
    return {
        "schema_version": META_VERSION,
        "made_by": "mmweaver process",
        "version": __version__,
        "frames": len(cube.grid.frame_time_s),
        "iq_order": recording.iq_order,
        "tx_order": cube.config.tx_order,
        "axes": recording.axes,
        "points": steps.points,
        "static_removal": steps.static_removal,
        **_board_metas(recording),
        "warnings": warnings,
        "analysis": None if analysis is None else analysis.meta(),
        "firmware": _firmware(steps.points, recording.radar_source),
        **radar_meta(cube.config),
        "inputs": {name: _digest(file) for name, file in recording.files.items()},
        **({} if recording.packets is None else _packets_meta(recording.path, recording.packets)),
        "assumed": [
            *_assumptions(recording),
            *recording.config.notes,
            *substitutes(steps.points, _firmware(steps.points, recording.radar_source)),
        ],
    }


def _board_metas(recording: Recording) -> dict[str, Any]:
    """Channel calibration that was applied, and the board whose errors were removed."""
    channels, board = recording.calibration, recording.board
    return {
        "calibration": None
        if channels is None
        else {
            "range_bias_m": channels.range_bias_m,
            "factor_abs": np.abs(channels.factors),
            "factor_rad": np.angle(channels.factors),
        },
        "board": None
        if board is None
        else {**board.board.meta(), "corrected": board.corrected, "left_in": board.left_in},
    }


def _warnings(recording: Recording, strict: bool) -> list[str]:
    """Deviations of samples from settings. Raises InputError for any in strict mode."""
    found = [*recording.notes, *_fewer_frames(recording)]
    if recording.lost_share is not None:
        found += loss_sentences(recording.lost_share)
    if recording.adc is None:
        return _refused_if(strict, found, recording.path)
    file = recording.files["recording"] if recording.axes is None else None
    times_s = None if recording.packets is None else recording.packets.frame_time_s
    found += implausible(recording.adc, recording.cube, file, iq_order=recording.iq_order, frame_time_s=times_s)
    return _refused_if(strict, found, recording.path)


def _refused_if(strict: bool, found: list[str], path: Path) -> list[str]:
    if found and strict:
        raise InputError(f"{path}: {'; '.join(found)} (strict)")
    return found


def _fewer_frames(recording: Recording) -> list[str]:
    """A sentence if the radar's file announces another number of frames than there are."""
    announced = None if recording.radar_source is None else announced_frames(recording.radar_source)
    held = recording.num_frames
    if announced is None or held is None or held == announced:
        return []
    return [f"{Path(recording.radar_source or '').name} announces {announced} frames, the recording has {held}"]


def _firmware(points: str, radar_source: str | None) -> FirmwareSettings | None:
    """Settings of TI's point cloud if they are needed. Raises InputError."""
    if points != "firmware":
        return None
    return FirmwareSettings() if radar_source is None else load_firmware(radar_source)


def _digest(path: Path) -> dict[str, str]:
    return {"path": str(path)} if path.is_dir() else file_digest(path)


def _packets_meta(folder: Path, packets: PacketCapture) -> dict[str, Any]:
    """Packet statistics, arrival times of the frames and the nearest photos."""
    meta = {"packets": packets.report, "frame_clock_s": np.round(packets.frame_time_s, 6)}
    camera = photo_folder(folder)
    if camera is None:
        return meta
    late_s = photo_times_s(camera) - packets.frame_time_s[:, None]
    nearest = np.abs(late_s).argmin(axis=1)
    return meta | {
        "photo_of_frame": nearest,
        "photo_minus_frame_s": np.round(np.take_along_axis(late_s, nearest[:, None], axis=1)[:, 0], 4),
    }


def _assumptions(recording: Recording) -> list[str]:
    """Assumptions on frame timing, and losses of packets."""
    if recording.stored_cube is not None:
        return []
    every = f"frames follow each other every {recording.config.frame_period_s * 1e3:g} ms, as"
    if recording.packets is None:
        return [f"{every} the radar's configuration says"]
    report = recording.packets.report
    sentences = [f"{every} the radar's configuration says; frame_clock_s holds when their first packets came"]
    if report.lost_bytes:
        sentences.append(f"{report.lost} packets were lost: {report.lost_bytes} bytes of samples")
    if report.bytes_after_last_frame:
        sentences.append(f"{report.bytes_after_last_frame} bytes of an unfinished last frame were left out")
    return sentences
