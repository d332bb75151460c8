"""Recordings of a DCA1000 as files hold them: split, with headers, with losses, ended within a frame."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.shapes import LostShare
from mmweaver.io.dca1000 import GROWING, adc_of_sent, bytes_of_frame, not_whole_frames
from mmweaver.io.dca_packets import packets_with_headers
from mmweaver.io.point_clouds.ti_uart import MAGIC
from mmweaver.io.sample_files import PACKET_BYTES, BinSamples, SentBytes, part_files
from mmweaver.recordings.missing_packets import missing_packets
from mmweaver.recordings.plausibility import other_layout
from mmweaver.signal.lost_chirps import frames_left_out, without_lost_chirps

PROBE_FRAMES = 4
MAP = "say what is in it in a mapping file and give it as --layout map.toml (docs/formats.md)"
# first bytes of files that are no recording of a DCA1000, and what to do with them
OTHERS = (
    (MAGIC, "a log of a TI demo's data port, which has points and no samples; read it with mmweaver points"),
    (b"MATLAB 5.0 MAT-file", f"a MATLAB file; {MAP}"),
    (b"MATLAB 7.3 MAT-file", f"a MATLAB file; {MAP}"),
    (b"\x89HDF", f"an HDF5 file; {MAP}"),
    (b"\x93NUMPY", "an array of numpy; name it .npy and give --layout with its axes"),
    (b"PK\x03\x04", "a zip archive; unpack it"),
)
MAX_RANGES = 8  # of frame numbers in a sentence


@dataclass(frozen=True, kw_only=True)
class DcaBin:
    """A recording whose files are known but not read.

    Attributes:
        source: Its bytes.
        num_frames: Complete frames.
        notes: What was found about the files, as sentences.
    """

    source: SentBytes
    num_frames: int
    notes: tuple[str, ...]


def open_dca_bin(path: Path, config: RadarConfig, iq_order: str | None = None) -> DcaBin:
    """Finds out how the files of a recording hold its frames.

    Args:
        path: adc_data.bin, or a part X_Raw_0.bin.
        config: The radar.
        iq_order: I/Q order. Default: the radar's.

    Returns:
        The recording.

    Raises:
        InputError: If a part is missing, there is less than a frame, or a rest of bytes and the samples themselves show
            that it is another radar's.
    """
    files = part_files(path)
    return _opened(files, config, iq_order, tuple((one.stat().st_mtime_ns, one.stat().st_size) for one in files))


@lru_cache(maxsize=4)  # a recording that is read in pieces is looked at once
def _opened(files: tuple[Path, ...], config: RadarConfig, iq_order: str | None, _changed: object) -> DcaBin:
    path, notes = files[0], []
    refuse_other_files(path)
    if len(files) > 1:
        notes.append(f"{len(files)} files, {path.name} to {files[-1].name}, were read as one recording")
    source: SentBytes | None = packets_with_headers(files)
    if source is not None:
        notes.append("the headers of the packets, which the file still holds, were used to put them in place")
    else:
        gaps = missing_packets(files, config)
        source = BinSamples(files, gaps)
        if gaps:
            lost = sum(gap.num_bytes for gap in gaps)
            where = _numbers(sorted({gap.at // bytes_of_frame(config) for gap in gaps}))
            notes.append(
                f"{lost // PACKET_BYTES} packets of {PACKET_BYTES} bytes are missing from the file, in frames {where}:"
                " the frames after them were read where they are"
            )
    num_frames, rest = divmod(source.size, bytes_of_frame(config))
    if num_frames == 0:
        raise InputError(not_whole_frames(path, source.size, config))
    if rest and not path.with_name(GROWING).is_file():
        few, _ = adc_of_sent(source, config, range(min(num_frames, PROBE_FRAMES)), iq_order=iq_order)
        if other := other_layout(few, iq_order or config.lvds_iq_order):
            raise InputError(f"{not_whole_frames(path, source.size, config)}; {other}")
        notes.append(f"{rest} bytes after the last whole frame were left out")
    return DcaBin(source=source, num_frames=num_frames, notes=tuple(notes))


def refuse_other_files(path: Path) -> None:
    """Names the kind of a file that holds no raw samples.

    Args:
        path: Any file.

    Raises:
        InputError: If its first bytes are those of another kind of file.
    """
    with open_regular(path) as file:
        head = file.read(32)
    for start, what in OTHERS:
        if head.startswith(start):
            raise InputError(f"{path} is {what}")


def read_frames(
    found: DcaBin, config: RadarConfig, frames: slice, iq_order: str | None = None
) -> tuple[AdcCube, LostShare]:
    """Reads frames with their lost chirps estimated.

    Args:
        found: The recording.
        config: The radar.
        frames: Range of frames.
        iq_order: I/Q order. Default: the radar's.

    Returns:
        Samples in ADC counts, and the share of each chirp's samples that was lost, (frame, loop, slot).

    Raises:
        InputError: If the number of complex samples per chirp is odd.
    """
    adc, lost_share = adc_of_sent(found.source, config, range(found.num_frames)[frames], iq_order=iq_order)
    return without_lost_chirps(adc, lost_share > 0), lost_share


def loss_sentences(lost_share: LostShare) -> list[str]:
    """What was lost, and what became of it.

    Args:
        lost_share: Share of each chirp's samples that was lost, (frame, loop, slot), of the whole recording.

    Returns:
        Sentences; none without losses.
    """
    is_lost = lost_share > 0
    if not is_lost.any():
        return []
    left_out = frames_left_out(is_lost)
    hurt = np.flatnonzero(is_lost.any(axis=(1, 2)) & ~left_out)
    share = f"{100 * lost_share.mean():.2g} % of the samples are lost"
    sentences = []
    if len(hurt):
        sentences.append(
            f"{share}: {is_lost.sum()} chirps, in frames {_numbers(hurt)}, take no part in Doppler and angle and were"
            " estimated from the others"
        )
    if left_out.any():
        sentences.append(
            f"{'' if len(hurt) else share + '; '}frames {_numbers(np.flatnonzero(left_out))} lack most chirps of a"
            " transmitter and are left out (zero)"
        )
    return sentences


def _numbers(frames: "np.ndarray | list[int]") -> str:
    """Frame numbers as ranges, such as 3, 5 to 9.

    >>> _numbers([3, 5, 6, 7])
    '3, 5 to 7'
    """
    values = np.asarray(frames)
    runs = np.split(values, np.flatnonzero(np.diff(values) > 1) + 1)
    texts = [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    return ", ".join(texts[:MAX_RANGES]) + (f" and {len(texts) - MAX_RANGES} more" if len(texts) > MAX_RANGES else "")
