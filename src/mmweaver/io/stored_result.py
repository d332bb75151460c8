"""Reads back a result folder of `mmweaver generate` or `mmweaver process`."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube
from mmweaver.core.safe_files.regular_files import check_exists
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.npz_files import read_points_npz, read_poses_npz, read_radar_npz

ADC_FILE = "adc_data.bin"


@dataclass(frozen=True, kw_only=True)
class StoredResult:
    """Content of a result folder."""

    folder: Path
    cube: RadarCube
    points: PointCloud
    poses: tuple[PoseSequence, ...]  # empty for recordings
    meta: dict[str, Any]

    @property
    def title(self) -> str:
        """Sentences and radar, for figures."""
        return f"{self.text}   ({self.cube.config.name})".strip()

    @property
    def text(self) -> str:
        """The sentences, or the name of the recording."""
        text = self.meta.get("text") or ""
        return text if isinstance(text, str) else " | ".join(map(str, text))

    @cached_property
    def adc(self) -> AdcCube:
        """Raw samples.

        Raises:
            InputError: If the folder has no adc_data.bin.
        """
        file = self.folder / ADC_FILE
        if not file.is_file():
            raise InputError(f"{self.folder} holds no {ADC_FILE}, which this format needs; generate it with --bin")
        written = self.meta.get("adc_data_bin") or {}
        order = written.get("tx_order") or None  # as `_check_meta` reads it
        config = self.cube.config if order is None else replace(self.cube.config, tx_order=tuple(order))
        return read_bin(file, config, iq_order=written.get("iq_order") or "iq")


def read_result(folder: Path) -> StoredResult:
    """Reads a result folder.

    Args:
        folder: The folder.

    Returns:
        Its content; raw samples are read when first used.

    Raises:
        InputError: If it is not a result folder, or damaged.
    """
    check_exists(folder, "a folder of mmweaver generate or mmweaver process")
    if not (folder / "radar.npz").is_file():
        raise InputError(f"{folder} holds no radar.npz; give a folder of mmweaver generate or mmweaver process")
    meta = read_json(folder / "meta.json") if (folder / "meta.json").is_file() else {}
    if not isinstance(meta, dict):
        raise InputError(f"{folder / 'meta.json'} is no JSON object; this is not a result folder of mmweaver")
    _check_meta(folder / "meta.json", meta)
    return StoredResult(
        folder=folder,
        cube=read_radar_npz(folder / "radar.npz"),
        points=read_points_npz(folder / "points.npz"),
        poses=read_poses_npz(folder / "pose.npz") if (folder / "pose.npz").is_file() else (),
        meta=meta,
    )


def _check_meta(path: Path, meta: dict[str, Any]) -> None:
    """Raises InputError if an entry of meta.json that is used has the wrong type."""
    text, written = meta.get("text") or "", meta.get("adc_data_bin") or {}
    texts = text if isinstance(text, list) else [text]
    if not all(isinstance(one, str) for one in texts):
        raise InputError(f"{path}: its text is no sentence and no list of sentences; generate the results again")
    order = (written.get("tx_order") or []) if isinstance(written, dict) else None
    is_order = isinstance(order, list) and all(type(one) is int for one in order)
    if not is_order or not isinstance(written.get("iq_order", "iq"), str):
        raise InputError(f"{path}: its adc_data_bin has no iq_order or tx_order; generate the results again")
