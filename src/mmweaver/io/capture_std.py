"""Radar data of a capture folder written by mmwave-capture-std: <capture>/<radar>/{radar.cfg, dca.pcap}.

Reference: mmwave-capture-std, "Dataset Directories Structure".
"""

from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.io.dca_packets import PacketCapture, read_pcap
from mmweaver.io.ti_cfg import read_ti_cfg, refuse_headers, ti_cfg_lines

PACKETS, RADAR = "dca.pcap", "radar.cfg"


@dataclass(frozen=True, kw_only=True)
class RadarCapture:
    """Radar data of a capture folder: reassembled packets and radar configuration."""

    folder: Path
    config: RadarConfig
    packets: PacketCapture


def is_capture(path: Path | str) -> bool:
    """Whether a path is a capture folder or the folder of a radar in one."""
    path = Path(path)
    return path.is_dir() and bool(_radar_folders(path))


def radar_folder(path: Path | str) -> Path:
    """Finds the folder of the only radar in a capture.

    Args:
        path: Capture folder, or the folder of the radar.

    Returns:
        Folder of the radar.

    Raises:
        InputError: If there is no radar, or more than one.
    """
    path = Path(path)
    found = _radar_folders(path) if path.is_dir() else []
    if not found:
        raise InputError(
            f"{path} is not a capture folder: neither it nor a folder in it holds {PACKETS}; give capture_00000/"
        )
    if len(found) > 1:
        names = ", ".join(str(folder) for folder in found)
        raise InputError(f"{path} holds several radars; give the folder of one: {names}")
    return found[0]


def read_radar_capture(path: Path | str, frames: slice = slice(None)) -> RadarCapture:
    """Reads the radar data of a capture.

    Args:
        path: Capture folder, or the folder of the radar.
        frames: Range of frames. Default: all.

    Returns:
        Samples, packet statistics and radar configuration.

    Raises:
        InputError: If a file is missing or damaged, or the samples have headers (lvdsStreamCfg).
    """
    folder = radar_folder(path)
    cfg = folder / RADAR
    if not cfg.is_file():
        raise InputError(f"{folder} holds {PACKETS} but no {RADAR}; put the .cfg of the recording there")
    config = read_ti_cfg(cfg)
    refuse_headers(str(cfg))
    num_frames = ti_cfg_lines(cfg)["frameCfg"][-1].whole(3)
    packets = read_pcap(folder / PACKETS, config, num_frames=num_frames or None, frames=frames)
    return RadarCapture(folder=folder, config=config, packets=packets)


def _radar_folders(path: Path) -> list[Path]:
    if (path / PACKETS).is_file():
        return [path]
    return sorted(folder for folder in path.iterdir() if (folder / PACKETS).is_file())
