"""The single reader of recordings: raw samples or a cube, from any supported file or folder.

radar.npz, or a folder that contains one   cube with its radar.json (written by mmweaver generate and process)
folder of mmweaver generate --stream       its complete parts as one cube
capture folder of mmwave-capture-std       radar.cfg, dca.pcap
folder of a DCA1000 capture                *.bin (X_Raw_0.bin, ...), with its .mmwave.json, .cfg, .lua or radar.json
folder of Infineon's Radar SDK             config.json, radar.npy
.mat, .h5, .hdf5, .npy                     an array by a mapping file (layout map.toml)
adc_data.bin                               raw samples as stored by a DCA1000
.pcap, .pcapng                             packets of a DCA1000
.npy                                       raw samples with named axes, or the array of another project (layout)
folder of .npy                             frames of HuPR
"""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board, ChannelCalibration
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import chosen_range
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.core.shapes import LostShare
from mmweaver.io.capture_folder import find_capture
from mmweaver.io.capture_std import PACKETS, RADAR, is_capture, read_radar_capture
from mmweaver.io.dca_packets import PacketCapture, read_pcap
from mmweaver.io.infineon import AXES, SAMPLES, SETTINGS, infineon_folder, read_infineon
from mmweaver.io.mapped_arrays import read_mapped, read_mapping
from mmweaver.io.npz_files import read_radar_npz
from mmweaver.io.peer_arrays import LAYOUTS, detect_layout
from mmweaver.io.radar_file import load_radar
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.io.stream_folder import is_stream, read_stream_cube
from mmweaver.io.ti_calibration import read_ti_calibration
from mmweaver.io.ti_cfg import refuse_headers
from mmweaver.propagation.board_correction import corrected
from mmweaver.recordings.dca_bin import open_dca_bin, read_frames
from mmweaver.signal.cube import adc_from_cube, cropped, radar_cube, tdm_compensation
from mmweaver.signal.lost_chirps import without_lost_chirps

CUBE = "radar.npz"
PACKET_SUFFIXES = (".pcap", ".pcapng")


@dataclass(frozen=True, kw_only=True)
class CorrectedBoard:
    """A board whose errors were removed.

    Attributes:
        board: The board.
        corrected: Errors that were removed.
        left_in: Errors that cannot be removed.
    """

    board: Board
    corrected: tuple[str, ...]
    left_in: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Recording:
    """A recording as read: raw samples, or a cube if the file contains no samples."""

    path: Path
    files: dict[str, Path]  # input files by their names in meta.json
    config: RadarConfig
    adc: AdcCube | None = None
    stored_cube: RadarCube | None = None
    compensate_tdm: bool = True  # False if all transmitters send simultaneously
    iq_order: str | None = None  # of int16 I/Q files
    axes: str | None = None  # of a .npy with named axes
    radar_source: str | None = None  # preset or file of the radar
    first_frame: int = 0  # index of the first frame read
    packets: PacketCapture | None = None  # of a capture folder or packet file
    calibration: ChannelCalibration | None = None  # channel calibration that was applied
    board: CorrectedBoard | None = None  # board whose errors were removed
    lost_share: LostShare | None = None  # of the samples of each chirp read; lost chirps are estimated
    num_frames: int | None = None  # frames of the whole recording, where only some of it were read
    notes: tuple[str, ...] = ()  # what was found about the files

    @cached_property
    def cube(self) -> RadarCube:
        """Range-Doppler cube (frame, range, doppler, antenna), computed at first use."""
        if self.stored_cube is not None:
            return self.stored_cube
        if self.adc is None:
            raise ValueError("a recording needs samples or a cube")
        cube = radar_cube(self.adc, compensate_tdm=self.compensate_tdm)
        return replace(cube, grid=CubeGrid.of(cube.config, len(cube.values), self.first_frame))


@dataclass(frozen=True, kw_only=True)
class RawReading:
    """How to read raw samples without metadata; None keeps the default."""

    radar: str | Path | RadarConfig | None = None  # name of a preset, file, or configuration
    layout: str | None = None  # project that wrote a .npy, a key of LAYOUTS
    axes: str | None = None  # axes of any other .npy, such as "frame,loop,tx,rx,sample"
    iq_order: str | None = None  # "iq", "qi" or "interleaved"; default: from the radar's file
    tx_order: tuple[int, ...] | None = None  # firing order; default: the radar's


def read_recording(
    path: str | Path,
    radar: str | Path | RadarConfig | None = None,
    *,
    range_m: tuple[float, float] | None = None,
    range_bins: tuple[int, int] | None = None,
    frames: slice = slice(None),
    mapped: bool = False,
    **samples: Any,
) -> Recording:
    """Reads a recording; its kind follows from the path.

    Args:
        path: File or folder, see the module's table.
        radar: Name of a preset, file of a radar, or configuration. A capture folder has its own, a radar.npz its
            radar.json, and arrays of other projects default to the preset of the same name.
        range_m: Range window (near, far) of the cube in metres. Default: that of a preset, or all bins of a .cfg.
        range_bins: The same as range bins (first, last).
        frames: Range of frames. Default: all.
        mapped: Whether the cube of a radar.npz is memory-mapped, read-only. Default: False.
        **samples: `layout`, `axes`, `iq_order` and `tx_order`, see `RawReading`. A .npy needs its `axes`, or a
            `layout`: "hupr" (recognised by its shape), "mmmesh", "rf_genesis", "cubelearn" or a mapping file (.toml).

    Returns:
        Raw samples, or the cube if the file contains no samples.

    Raises:
        InputError: If the file cannot be read with these settings.
        ValueError: If `frames` has a step or a negative start.
    """
    if frames.step not in (None, 1) or (frames.start or 0) < 0:
        raise ValueError("frames are a stretch that begins with a frame of the recording")
    found = _read(Path(path), RawReading(radar=radar, **samples), frames, mapped)
    return _cropped(found, range_m, range_bins)


def _read(path: Path, reading: RawReading, frames: slice, mapped: bool) -> Recording:
    """Reads a recording with the range bins of its radar."""
    layout, radar = reading.layout, reading.radar
    if layout is not None and layout.endswith(".toml"):
        return _read_mapped(path, reading, frames)
    if layout is not None and (layout not in LAYOUTS or reading.axes is not None):
        raise InputError(f"give a layout ({', '.join(LAYOUTS)}) or axes, not both; got {layout!r} and {reading.axes!r}")
    check_exists(path, "a recording or a capture folder")
    if path.is_dir() and layout is None and (found := _read_folder(path, reading, frames, mapped)) is not None:
        return found
    if path.suffix == ".npz":
        return _stretch(_read_cube(path, radar, mapped), frames)
    if path.name == SAMPLES and layout is None and reading.axes is None and infineon_folder(path.parent) is not None:
        return _read_infineon(path.parent, reading, frames)
    if (path.suffix == ".npy" or path.is_dir()) and reading.axes is None:
        layout = layout or detect_layout(path)
    radar = radar if radar is not None or layout == "cubelearn" else layout
    if radar is None:
        raise InputError(
            f"{path}: which radar recorded it? give --radar, for example --radar awr1843; only a capture folder and"
            f" {CUBE} bring their own"
        )
    config = as_config(radar)
    if reading.tx_order is not None:
        config = replace(config, tx_order=reading.tx_order)
    source = None if isinstance(radar, RadarConfig) else str(radar)
    found = Recording(path=path, files={"recording": path}, config=config, radar_source=source)
    if layout is not None:
        return _stretch(_read_layout(found, layout), frames)
    found = replace(_read_samples(found, reading, frames), first_frame=frames.start or 0)
    return _calibrated(found, None if source is None else read_ti_calibration(source))


def _read_mapped(path: Path, reading: RawReading, frames: slice) -> Recording:
    """Reads an array as a mapping file says, whose radar is taken unless another is given."""
    mapping = read_mapping(Path(reading.layout or ""))
    radar = reading.radar if reading.radar is not None else mapping.radar
    if radar is None:
        raise InputError(f'{mapping.path} names no radar; add radar = "profile.cfg" or give --radar')
    config = as_config(radar)
    if reading.tx_order is not None:
        config = replace(config, tx_order=reading.tx_order)
    found = Recording(
        path=path,
        files={"recording": path, "mapping": mapping.path},
        config=config,
        adc=read_mapped(path, mapping, config, frames),
        axes=mapping.axes,
        radar_source=None if isinstance(radar, RadarConfig) else str(radar),
        first_frame=frames.start or 0,
    )
    return found


def _read_samples(found: Recording, reading: RawReading, frames: slice) -> Recording:
    """Reads a .npy with named axes, or the packets or the .bin of a DCA1000."""
    path, config, iq_order = found.path, found.config, reading.iq_order or found.config.lvds_iq_order
    if reading.axes is not None:
        return replace(found, adc=read_adc_npy(path, config, reading.axes, frames=frames), axes=reading.axes)
    if found.radar_source is not None:
        refuse_headers(found.radar_source)
    if path.suffix.lower() in PACKET_SUFFIXES:
        packets = read_pcap(path, config, iq_order=iq_order, frames=frames)
        return replace(found, iq_order=iq_order, **_of_packets(packets))
    opened = open_dca_bin(path, config, iq_order)
    adc, lost_share = read_frames(opened, config, frames, iq_order)
    return replace(
        found, adc=adc, lost_share=lost_share, num_frames=opened.num_frames, notes=opened.notes, iq_order=iq_order
    )


def _of_packets(packets: PacketCapture) -> dict[str, Any]:
    """Fields of a recording from its packets, lost chirps estimated."""
    adc = without_lost_chirps(packets.adc, packets.lost_share > 0)
    return {
        "adc": adc,
        "lost_share": packets.lost_share,
        "num_frames": packets.num_frames,
        "packets": replace(packets, adc=adc),
    }


def _stretch(found: Recording, frames: slice) -> Recording:
    """Selects frames of a recording that was read completely."""
    if frames == slice(None):
        return found
    cube = None if found.stored_cube is None else found.stored_cube.select(frames)
    adc = None if found.adc is None else replace(found.adc, samples=found.adc.samples[frames])
    return replace(found, stored_cube=cube, adc=adc, first_frame=frames.start or 0)


def _calibrated(found: Recording, calibration: ChannelCalibration | None) -> Recording:
    """Applies the channel calibration of the .cfg, except to samples of simultaneous transmitters."""
    if calibration is None or found.adc is None or found.config.is_coded:
        return found
    return replace(found, adc=calibration.compensated(found.adc), calibration=calibration)


def _cropped(found: Recording, range_m: tuple[float, float] | None, range_bins: tuple[int, int] | None) -> Recording:
    """Selects range bins. Raises InputError if the radar or the stored cube lacks them."""
    config = chosen_range(found.config, range_m, range_bins)
    if config == found.config:
        return found
    adc = None if found.adc is None else replace(found.adc, config=config)
    cube = None if found.stored_cube is None else cropped(found.stored_cube, config)
    return replace(found, config=config, adc=adc, stored_cube=cube)


def without_board(found: Recording, board: Board) -> Recording:
    """Removes the errors of the board from a recording.

    A cube is converted back to samples, so a range bias shifts no echoes from outside its range window into it.

    Args:
        found: The recording.
        board: The board that made it.

    Returns:
        The corrected recording, with a list of the errors that were removed.

    Raises:
        InputError: If the board does not fit the radar.
    """
    samples = found.adc
    if samples is None:
        assert found.stored_cube is not None
        samples = adc_from_cube(found.stored_cube)
    fixed = corrected(samples, board)
    done = CorrectedBoard(board=board, corrected=fixed.corrected, left_in=fixed.left_in)
    stored = found.stored_cube
    if stored is not None:
        values = radar_cube(fixed.adc, compensate_tdm=found.compensate_tdm).values
        stored = replace(stored, values=values, config=fixed.adc.config)
        grid = replace(CubeGrid.of(fixed.adc.config, len(values)), frame_time_s=stored.grid.frame_time_s)
        stored = replace(stored, grid=grid)
    adc = None if found.adc is None else fixed.adc
    return replace(found, adc=adc, stored_cube=stored, config=fixed.adc.config, board=done)


def as_config(radar: str | Path | RadarConfig) -> RadarConfig:
    """Resolves a radar.

    Args:
        radar: Name of a preset, file of a radar, or configuration.

    Returns:
        The configuration.

    Raises:
        InputError: If the name is unknown or the file is malformed.
    """
    return radar if isinstance(radar, RadarConfig) else load_radar(str(radar))


def _read_folder(path: Path, reading: RawReading, frames: slice, mapped: bool) -> Recording | None:
    """Reads the recording in a folder; None for frames of HuPR. Raises InputError if it contains no recording."""
    if (path / CUBE).is_file():
        return _stretch(_read_cube(path / CUBE, reading.radar, mapped), frames)
    if is_stream(path):
        cube = read_stream_cube(path, frames)
        return Recording(path=path, files={"recording": path}, config=cube.config, stored_cube=cube)
    if is_capture(path):
        return _read_capture(path, reading, frames)
    if (avian := infineon_folder(path)) is not None:
        return _read_infineon(avian, reading, frames)
    if (capture := find_capture(path)) is not None:
        own = reading if reading.radar is not None else replace(reading, radar=capture.radar)
        found = _read(capture.recording, own, frames, mapped)
        return replace(found, notes=(*found.notes, *capture.notes))
    if any(path.glob("*.npy")):
        return None
    raise InputError(
        f"{path} is not a capture folder ({PACKETS}, *.bin, or Infineon's radar.npy) and holds neither {CUBE} nor"
        " frames of HuPR (.npy); give a folder that mmweaver process wrote"
    )


def _read_infineon(folder: Path, reading: RawReading, frames: slice) -> Recording:
    """Reads a folder of Infineon's Radar SDK, whose config.json is the radar unless another is given."""
    adc = read_infineon(folder, None if reading.radar is None else as_config(reading.radar), frames)
    files = {"recording": folder / SAMPLES, "radar": folder / SETTINGS}
    found = Recording(path=folder, files=files, config=adc.config, adc=adc, axes=AXES, radar_source=str(files["radar"]))
    return replace(found, first_frame=frames.start or 0, num_frames=len(read_npy(folder / SAMPLES, mapped=True)))


def _read_cube(path: Path, radar: str | Path | RadarConfig | None, mapped: bool) -> Recording:
    cube = read_radar_npz(path, None if radar is None else as_config(radar), mapped=mapped)
    source = None if radar is None or isinstance(radar, RadarConfig) else str(radar)
    return Recording(path=path, files={"recording": path}, config=cube.config, stored_cube=cube, radar_source=source)


def _read_capture(path: Path, reading: RawReading, frames: slice) -> Recording:
    """Reads a capture folder. Raises InputError for options, since its radar.cfg determines everything."""
    if given := [name for name, value in vars(reading).items() if value is not None]:
        option = "--" + given[0].replace("_", "-")
        raise InputError(f"{path} is a capture folder, whose {RADAR} says it all; leave out {option}")
    capture = read_radar_capture(path, frames)
    cfg = capture.folder / RADAR
    found = Recording(
        path=capture.folder,
        files={"recording": capture.folder / PACKETS, "radar": cfg},
        config=capture.config,
        iq_order=capture.config.lvds_iq_order,
        radar_source=str(cfg),
        first_frame=frames.start or 0,
        **_of_packets(capture.packets),
    )
    return _calibrated(found, read_ti_calibration(str(cfg)))


def _read_layout(found: Recording, layout: str) -> Recording:
    """Reads the array of another project: a cube (HuPR) or samples."""
    read = LAYOUTS[layout](found.path, found.config)
    if isinstance(read, RadarCube):
        cube = replace(read, values=np.asarray(read.values * tdm_compensation(read.config)))
        return replace(found, config=read.config, stored_cube=cube)
    return replace(found, config=read.config, adc=read, compensate_tdm=layout != "rf_genesis")
