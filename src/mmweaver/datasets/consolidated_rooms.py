"""The metadata of all rooms of a finished data set, gathered in that of its root.

Readers then need not list the folders, where plan.json and SHA256SUMS are no part of Zarr (it warns of each), and open
thousands of arrays by one file. The text follows from the rooms alone, so that processes that finish together write the
same. Reference: consolidated metadata of zarr-python 3.
"""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_files
from mmweaver.core.checksums import SUMS_FILE, read_sums, sums_text
from mmweaver.core.safe_files.safe_text import read_json

METADATA = "zarr.json"
KEY = "consolidated_metadata"


def consolidate_rooms(folder: Path, rooms: Sequence[str], axes: Sequence[str]) -> None:
    """Writes the root's zarr.json anew where it lacks something of these rooms and axes, and its checksum.

    Raises InputError where metadata of a room is damaged.
    """
    root = read_json(folder / METADATA)
    files = [file for name in (*axes, *sorted(rooms)) for file in sorted((folder / name).rglob(METADATA))]
    members: dict[str, Any] = {file.parent.relative_to(folder).as_posix(): read_json(file) for file in files}
    gathered = {"kind": "inline", "must_understand": False, "metadata": members}
    text = json.dumps(root | {KEY: gathered})
    held = read_sums(folder) or {}
    sums = held | {METADATA: hashlib.sha256(text.encode()).hexdigest()}
    if root.get(KEY) == gathered and sums == held:  # a kill may have come between the two files
        return
    with atomic_files(folder / METADATA, folder / SUMS_FILE) as (metadata, listed):
        metadata.write_text(text, encoding="utf-8")
        listed.write_text(sums_text(sums), encoding="utf-8")
