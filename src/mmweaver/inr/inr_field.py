"""A fitted network as a field that can be sampled anywhere, saved and read back."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.field_file import FieldFile, read_field
from mmweaver.compression.mmw_field import open_mmw
from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.signal_field import Coordinates, SignalField, cells_at, coordinates_on
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.shapes import CubeValues
from mmweaver.inr.networks import BaseINR, ModulatedINR, PositionalEncoding
from mmweaver.inr.separable import SeparableINR
from mmweaver.signal.point_response import Axes, PointResponse

POINTS_AT_ONCE = 1 << 14
Network = BaseINR | SeparableINR


class InrField(SignalField):
    """A sequence represented by an INR.

    Args:
        network: `ModulatedINR`, `BaseINR` or `SeparableINR`.
        config: The radar.
        grid: Cells of the sequence.
        scale: Scale of its cube.
        amplitude: Value of the network's 1.0 in the unit of the cube.
        is_centred: Whether the network represents the cube without its carrier, the phase by which the spectra of
            windows turn from bin to bin (`PointResponse.phasor`).
    """

    def __init__(
        self, network: Network, *, config: RadarConfig, grid: CubeGrid, scale: float, amplitude: float, is_centred: bool
    ) -> None:
        self.network, self.amplitude, self.is_centred = network.eval().requires_grad_(False), amplitude, is_centred
        self.config, self.grid, self.scale = config, grid, scale
        self._response = PointResponse(config)

    @property
    def num_values(self) -> int:
        """Parameters of the network."""
        return sum(parameter.numel() for parameter in self.network.parameters())

    def sample(self, coordinates: Coordinates) -> np.ndarray:
        """Values at any coordinates; see `SignalField.sample`."""
        out = np.empty(len(coordinates), np.complex64)
        for frame in np.unique(coordinates[:, 0]):
            every = np.flatnonzero(coordinates[:, 0] == frame)
            for some in np.array_split(every, -(-len(every) // POINTS_AT_ONCE)):
                out[some] = self._points(coordinates[some], torch.tensor([float(frame)]))
        return out

    def _points(self, at: Coordinates, time: Tensor) -> np.ndarray:
        axes = self._response.axes(cells_at(self.grid, at))
        if isinstance(self.network, SeparableINR):
            iq = self.network(axes, time, is_grid=False)[0]
        else:
            x = torch.stack(self._normalised(list(at.T)), dim=-1)
            if isinstance(self.network, ModulatedINR):
                gamma, beta = self.network.modulation(time)
                iq = self.network(x[None, :, 1:], gamma=gamma, beta=beta)[0]
            else:
                iq = self.network(x)
        return self._values(iq, axes, is_grid=False)

    def values_on(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid of this radar; see `SignalField.values_on`."""
        at = coordinates_on(self.grid, grid)
        axes, time = self._response.axes(grid), torch.from_numpy(at[0]).float()
        if isinstance(self.network, SeparableINR):
            iq = torch.cat([self.network(axes, frame) for frame in time.split(1)])
        elif isinstance(self.network, ModulatedINR):
            iq = self.network.on_axes(self._normalised(at)[1:], time)
        else:
            frame, *others = self._normalised(at)
            iq = torch.stack([self.network.on_axes([own, *others]) for own in frame.split(1)])
        return self._values(iq.reshape(*grid.shape, 2), axes, is_grid=True)

    def _normalised(self, cells: Sequence[np.ndarray]) -> list[Tensor]:
        return [normalised(cell, num) for cell, num in zip(cells, self.grid.shape, strict=True)]

    def _values(self, iq: Tensor, axes: Axes, *, is_grid: bool) -> np.ndarray:
        values = torch.view_as_complex(iq.contiguous()) * self.amplitude
        return (values * self._response.phasor(axes, is_grid=is_grid) if self.is_centred else values).numpy()

    def save(self, path: Path | str) -> None:
        """Writes the field as safetensors; `load` reads it back, bit for bit.

        Args:
            path: The file.

        Raises:
            InputError: If it cannot be written.
        """
        about: dict[str, Any] = {"amplitude": self.amplitude, "is_centred": self.is_centred}
        network = self.network
        if isinstance(network, BaseINR):
            about |= {"sizes": network.sizes, "activation": network.activation}
            about |= {"frequencies": network.encoding.frequencies}
        FieldFile(
            kind=type(network).__name__, about=about, tensors=network.state_dict(), config=self.config, grid=self.grid,
            scale=self.scale,
        ).write(path)  # fmt: skip

    @classmethod
    def of(cls, file: FieldFile) -> "InrField":
        """The field of a file."""
        about, tensors = file.about, file.tensors
        network: Network
        if file.kind == "SeparableINR":
            frames, rank, directions = tensors["direction"].shape
            shared = len(tensors["static_range_shift"])
            network = SeparableINR(frames, rank=rank, num_shared=shared, num_directions=directions)
        else:
            encoding = PositionalEncoding(frequencies=[tuple(own) for own in about["frequencies"]])
            size = {"width": about["sizes"][1], "depth": len(about["sizes"]) - 2, "activation": about["activation"]}
            network = BaseINR(encoding=encoding, **size)
            if file.kind == "ModulatedINR":
                network = ModulatedINR(len(tensors["gamma"]), encoding=encoding, **size)
        network.load_state_dict(tensors)
        return cls(
            network, config=file.config, grid=file.grid, scale=file.scale, amplitude=about["amplitude"],
            is_centred=about["is_centred"],
        )  # fmt: skip


def normalised(cell: np.ndarray, num_cells: int) -> Tensor:
    """Cell indices 0..num-1 mapped to [-1, 1]; the one cell of an axis of length 1 to 0; float32."""
    at = 2 * cell / (num_cells - 1) - 1 if num_cells > 1 else np.zeros(len(cell))
    return torch.from_numpy(np.asarray(at, np.float32))


def load(path: Path | str) -> SignalField:
    """Opens a field.

    Args:
        path: A file of `SignalField.save` or `mmweaver fit`, or a .mmw file.

    Returns:
        The field: of scatterers, of a network, or of the .mmw file.

    Raises:
        InputError: If the file is missing, damaged, or no field.
    """
    if Path(path).suffix.lower() == ".mmw":
        return open_mmw(path)
    file = read_field(path)
    try:
        return ScattererField.of(file) if file.kind == ScattererField.__name__ else InrField.of(file)
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:120]
        raise InputError(f"{path} does not fit this version's fields ({reason}); fit the field again") from None
