"""Fields as safetensors files: tensors of the field, axes of its grid, and a header with its kind and radar."""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.tensor_files import read_tensors, write_tensors

FORMAT, VERSION = "mmweaver field", "1"
AXES = ("frame_time_s", "range_m", "radial_velocity_mps", "antenna_position_m")


@dataclass(frozen=True, kw_only=True)
class FieldFile:
    """What a file of a field holds.

    Attributes:
        kind: Kind of field.
        about: Its settings, JSON.
        tensors: Its parameters by name.
        config: The radar.
        grid: Native grid.
        scale: Scale of the cube; nan if unknown.
    """

    kind: str
    about: dict[str, Any]
    tensors: dict[str, Tensor]
    config: RadarConfig
    grid: CubeGrid
    scale: float

    def write(self, path: Path | str) -> None:
        """Writes the file atomically; InputError if it cannot be written."""
        scale = None if math.isnan(self.scale) else self.scale
        header = {
            "format": FORMAT, "format_version": VERSION, "kind": self.kind, "radar": self.config.to_json(),
            "about": json.dumps({**self.about, "scale": scale, "wavelength_m": self.grid.wavelength_m}),
        }  # fmt: skip
        axes = {f"grid.{name}": torch.from_numpy(getattr(self.grid, name).copy()) for name in AXES}
        write_tensors(Path(path), {**self.tensors, **axes}, header)


def read_field(path: Path | str) -> FieldFile:
    """Reads the file of a field.

    Raises:
        InputError: If the file is missing, damaged, or no field.
    """
    tensors, header = read_tensors(Path(path))
    if header.get("format") != FORMAT:
        raise InputError(f"{path} holds no field; give a file that mmweaver fit wrote")
    if header.get("format_version") != VERSION:
        raise InputError(f"{path} is a field of format {header.get('format_version')}, this mmweaver reads {VERSION}")
    try:
        config = RadarConfig.from_json(header["radar"])
        about = dict(parse_json(header["about"], f"the header of {path}"))
        scale = about.pop("scale")
        axes = {name: tensors.pop(f"grid.{name}").numpy() for name in AXES}
        grid = replace(CubeGrid.of(config, 1), **axes, wavelength_m=float(about.pop("wavelength_m")))
        kind = header["kind"]
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path} has a header that cannot be read ({error}); fit the field again") from None
    scale = math.nan if scale is None else float(scale)
    return FieldFile(kind=kind, about=about, tensors=tensors, config=config, grid=grid, scale=scale)
