"""A folder of a DCA1000 capture: its .bin files, the radar's settings, and the log of the capture card.

mmWave Studio writes adc_data.bin or adc_data_Raw_0.bin, ..., a _LogFile.txt or .csv, and .mmwave.json files or the Lua
script; recorders of others put the .cfg next to the samples.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_json, read_text
from mmweaver.io.mmwave_studio import is_mmwave_studio
from mmweaver.io.sample_files import part_files

SETTINGS = ("*.mmwave.json", "*.cfg", "*.lua", "radar.json")
FILLED = re.compile(r"zero[ -]?filled packets\s*[-:=,]\s*(\d+)", re.IGNORECASE)
MAX_LOG_BYTES = 10_000_000


@dataclass(frozen=True, kw_only=True)
class CaptureFolder:
    """What a folder holds.

    Attributes:
        recording: The .bin, or its first part.
        radar: File of the radar; None if there is none.
        notes: What the log of the capture card states, as sentences.
    """

    recording: Path
    radar: Path | None
    notes: tuple[str, ...]


def find_capture(folder: Path) -> CaptureFolder | None:
    """Finds the recording and its settings in a folder.

    Args:
        folder: The folder.

    Returns:
        The files; None without a .bin of samples.

    Raises:
        InputError: If there are several recordings, or several radars of one kind.
    """
    bins = sorted(one for one in folder.glob("*.bin") if one.is_file())
    if not bins:
        return None
    firsts = {part_files(one)[0] for one in bins}
    if len(firsts) > 1:
        raise InputError(
            f"{folder} holds several recordings; give one: {', '.join(sorted(one.name for one in firsts))}"
        )
    notes = []
    for log in sorted((*folder.glob("*LogFile*"), *folder.glob("*_log*.csv"))):
        filled = sum(int(count) for count in FILLED.findall(read_text(log, max_bytes=MAX_LOG_BYTES, errors="replace")))
        if filled:
            notes.append(f"{log.name} counts {filled} packets that were filled with zeros")
    return CaptureFolder(recording=firsts.pop(), radar=_radar(folder), notes=tuple(notes))


def _radar(folder: Path) -> Path | None:
    for pattern in SETTINGS:
        found = sorted(folder.glob(pattern))
        if pattern.endswith(".mmwave.json"):
            found = [one for one in found if is_mmwave_studio(read_json(one))]
        if len(found) > 1:
            raise InputError(f"{folder} holds several settings; give --radar: {', '.join(one.name for one in found)}")
        if found:
            return found[0]
    return None
