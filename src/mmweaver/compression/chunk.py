"""A chunk of frames in one stream: static layer, scatterers, low rank and residual, in the order of their decoding.

All are quantised with one step: an error of one step in any value leaves about the same energy in the cube.
"""

import math
import struct
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.cell_sample import CellSample
from mmweaver.compression.chunk_frames import ChunkFrames
from mmweaver.compression.chunk_transform import ChunkTransform, TransformChoice
from mmweaver.compression.coded_chunk import ChunkDraft, ChunkLayers, ChunkMode, CodedChunk
from mmweaver.compression.entropy import BitStream, Decoder, Encoder
from mmweaver.compression.exact_chunk import pack_exact, unpack_exact
from mmweaver.compression.low_rank import Components, RankFactors, components_of
from mmweaver.compression.moving_cells import code_moving, decoded_moving, moving_cells, pack_steps, unpack_steps
from mmweaver.compression.noise_layer import NoiseLayer, to_noise, without_signal
from mmweaver.compression.point_coder import PointCoder, PointSteps, dequantize, nearness, quantize, uniform_bits
from mmweaver.compression.residual_stream import (
    USUAL_PRICE,
    Price,
    QuantizedCells,
    cell_energy,
    code_cells,
    estimated_cell_bits,
    quantized,
)
from mmweaver.compression.static_levels import code_static, static_bits, static_levels, static_of
from mmweaver.compression.transforms import beams_of
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import CubeValues
from mmweaver.dsp.point_response import Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.layers import Layers, no_points, rendered, static_cells, strongest, values_of_point
from mmweaver.fields.scatterers.refinement import Damping, refined

# frames, hop, peak, step, centroids of 1 and of more, noise, which of COARSE_STEPS, rank, flags
PREFIX = struct.Struct("<HHffBBBBBB")
HAS_STATIC, HAS_POINTS, HAS_CELLS, HAS_GAINS, HAS_RANK, IS_EXACT, HAS_NOISE, IS_NEW = 1, 2, 4, 8, 16, 32, 64, 128
LEAST_SIZE = 2  # steps; weaker scatterers cost fewer bits as residual
REFINED_STEPS = 3
KEPT_SHARE = 0.85  # of the scatterers that were fitted, from which on they stay as they are
NEAR = 0.4  # difference of log(step) within which counted scatterers are taken for those of another step
SAME_COUNT = 0.15  # relative difference in count within which refined scatterers are reused
USUAL_RANK_BITS = 1.02  # of factors, over those estimated
GAIN_STEPS = 64.0
LEAST_GAIN = 0.03  # antenna gains that differ less from 1 are dropped
# hostile headers: a chunk of several frames, and one frame, have at most so many complex numbers
MOST_VALUES, MOST_CELLS = 2**21, 2**26


@dataclass(frozen=True, kw_only=True)
class DecodedChunk:
    """Content of a chunk. `residual`: working frames (frame, range, doppler, antenna) in centred phase.

    `layers` are None where a chunk has neither scatterers nor a static layer.
    """

    frames: ChunkFrames
    layers: Layers | None
    residual: np.ndarray | None
    peak: float
    noise_power: float
    num_residual_values: int = 0  # non-zero residual values
    rank: int = 0
    has_noise: bool = False
    exact: CubeValues | None = None
    step: float = 0.0  # relative to the peak
    transform: TransformChoice | None = None

    def mode_name(self) -> str:
        """How the chunk is coded, for people."""
        if self.exact is not None:
            return "exact"
        parts = ["scatterers"] * (self.layers is not None) + ["low rank"] * bool(self.rank)
        parts += ["noise"] * self.has_noise
        parts += [self.transform.name()] if self.transform else []
        return " + ".join(parts) or "nothing"

    def cube_values(self) -> CubeValues:
        """The frames of the cube, complex64."""
        if self.exact is not None:
            return finite(self.exact)
        working = np.zeros(self.frames.working_shape, np.complex64)
        if self.layers is not None:
            with torch.inference_mode():
                window = self.frames.fit_window()
                working = working + rendered(self.layers, window.response, window.axes).numpy()
        if self.residual is not None:
            working = working + self.residual
        return finite(self.frames.cube_values(working * np.float32(self.peak)))


@dataclass(kw_only=True)
class ChunkEncoder:
    """Encodes frames at any step. `target`: working frames (frame, range, doppler, antenna) over `peak`.

    `layers`: fitted scatterers, required by modes with points.
    """

    frames: ChunkFrames
    target: np.ndarray
    peak: float
    noise_power: float
    active_power: float | None = None  # above it a cell is active; None = 12 dB above the median
    layers: Layers | None = None
    _transforms: dict[tuple[bool, bool], ChunkTransform] = field(default_factory=dict)
    _samples: dict[TransformChoice, CellSample] = field(default_factory=dict)
    _refined_points: tuple[int, Points] | None = None
    _adaptive_bits: float | None = None  # of a scatterer coded before, but for those that are counted
    _rank_bits: float | None = None  # of factors coded before, over those estimated
    _noise: tuple[ChunkMode, bool, NoiseLayer] | None = None
    _quiet: dict[ChunkMode, np.ndarray] = field(default_factory=dict)  # coefficients of what has no signal
    _noise_sample: CellSample | None = None
    _whole_sample: CellSample | None = None
    _components: Components | None = None
    _counted_points: ChunkLayers | None = None  # of the last step at which they were

    def __post_init__(self) -> None:
        self.beams = beams_of(self.frames.config)
        self.is_active = active_cells(self.target, self.active_power)
        self._plain = ChunkLayers(step=1.0, target=self.target, near=np.zeros(self.target.shape[:3], np.int64))

    def with_layers(self, layers: Layers) -> None:
        """Takes fitted scatterers for the modes that use them."""
        if bool((layers.calibration - 1).abs().max() < LEAST_GAIN):
            layers = replace(layers, calibration=torch.ones_like(layers.calibration))
        self.layers = replace(layers, calibration=_quantize_gains(layers.calibration))

    def encode(
        self, step: float, mode: ChunkMode, coarser: int, price: Price = USUAL_PRICE, *, only_size: bool = False
    ) -> CodedChunk:
        """The chunk with an error of about step / sqrt(12) in each coded cell, relative to the peak.

        `only_size`: its size is estimated, and nothing coded that takes long.
        """
        if mode.only_noise:
            return self._as_noise(step, mode, price, only_size=only_size)
        draft = self.draft(step, mode, coarser, only_size=only_size)
        step, stream, flags, front = draft.step, draft.stream, draft.flags + IS_NEW, draft.front
        cell_bytes = 0.0
        cells = quantized(draft.coefficients, step, coarser, draft.is_active, price, draft.energy)
        is_open = cells.classes > 0
        if is_open.any():
            flags += HAS_CELLS
            front += draft.transform.packed
            correlated = draft.transform.correlated
            if only_size:
                cell_bytes = estimated_cell_bits(cells.levels, cells.classes, draft.near, correlated, coarser) / 8
            else:
                code_cells(stream, cells.levels, cells.classes, draft.near, correlated, coarser)
        is_active, lost = draft.is_active, draft.energy.astype(np.float64)
        if draft.transform.choice.range_dct or mode.finer > 1:  # errors are those of the cells of the frames
            rest = draft.transform.inverse(draft.coefficients - cells.values(step, coarser))
            is_active, lost = self.is_active, cell_energy(np.moveaxis(rest, 3, 0))
            if mode.finer > 1:
                lost = code_moving(stream, rest, self.beams, moving_cells(is_active), step / mode.finer)
        else:
            lost[is_open] = cell_energy(draft.coefficients[:, is_open] - cells.open_values(step, coarser))
        prefix = self._prefix(step, flags, cells.centroids, pack_steps(coarser or 1, mode.finer), draft.rank)
        data = prefix + front + stream.to_bytes()
        return CodedChunk(
            data=b"" if only_size else data, num_bytes=len(data) + draft.uncoded_bytes + cell_bytes,
            active_error=float(lost[is_active].sum()), all_error=float(lost.sum()), step=step, mode=mode, draft=draft,
        )  # fmt: skip

    def _prefix(
        self, step: float, flags: int, centroids: tuple[int, int] = (0, 0), steps: int = 0, rank: int = 0
    ) -> bytes:
        num, hop, noise = self.frames.num_frames, self.frames.hop, _noise_level(self.noise_power)
        return PREFIX.pack(num, hop, self.peak, step, *centroids, noise, steps, rank, flags)

    def _as_noise(self, step: float, mode: ChunkMode, price: Price, *, only_size: bool) -> CodedChunk:
        """The chunk as a noise layer of everything, and no cells."""
        step, coefficients = float(np.float32(step)), self._all_as_noise
        noise = NoiseLayer.of(coefficients, step, self.beams, price, only_size=only_size)
        lost = cell_energy(np.moveaxis(self.target - noise.values, 3, 0)).astype(np.float64)
        front = self._prefix(step, HAS_NOISE + IS_NEW, steps=pack_steps(1, 1)) + Encoder().to_bytes()
        draft = ChunkDraft(
            step=step, stream=Encoder(), flags=HAS_NOISE, front=noise.packed, front_bytes=float(len(front)),
            uncoded_bytes=0.0, noise_bytes=noise.num_bytes, near=self._plain.near, rank=0, num_values=0,
            transform=self._transform(mode.transform), coefficients=coefficients,
            is_active=np.ones(coefficients.shape[1:], bool), energy=cell_energy(coefficients),
        )  # fmt: skip
        return CodedChunk(
            data=b"" if only_size else front[: PREFIX.size] + noise.packed + front[PREFIX.size :],
            num_bytes=len(front) + noise.num_bytes, active_error=float(lost[self.is_active].sum()),
            all_error=float(lost.sum()), step=step, mode=mode, draft=draft,
        )  # fmt: skip

    @cached_property
    def _all_as_noise(self) -> np.ndarray:
        return to_noise(self.target, self.beams)

    def draft(self, step: float, mode: ChunkMode, coarser: int, *, only_size: bool = False) -> ChunkDraft:
        """The chunk with its layers coded, and its cells not; with `only_size` layers are counted."""
        step = float(np.float32(step))
        layers = self._layers(step, mode, coarser, only_size=only_size)
        stream, flags, front, target = layers.stream, layers.flags, layers.front, layers.target
        uncoded_bytes = layers.uncoded_bytes + layers.num_values / 8 * math.log2(layers.step / step)
        noise_bytes = 0.0
        if mode.noise_step:
            noise = self._noise_layer(mode, target, only_size=only_size)
            flags += HAS_NOISE
            front += noise.packed
            noise_bytes = noise.num_bytes
            uncoded_bytes += noise_bytes - len(noise.packed)
            layers = replace(layers, target=target - noise.values, transformed={})
        transform, coefficients = self._transformed(mode.transform, layers)
        return ChunkDraft(
            step=step, stream=stream, flags=flags, front=front, uncoded_bytes=uncoded_bytes,
            noise_bytes=noise_bytes,
            front_bytes=PREFIX.size + len(front) + len(transform.packed) + len(stream.to_bytes()) + uncoded_bytes,
            near=layers.near, rank=layers.rank, num_values=layers.num_values, transform=transform,
            coefficients=coefficients,
            is_active=transform.spread(self.is_active), energy=cell_energy(coefficients),
        )  # fmt: skip

    def _layers(self, step: float, mode: ChunkMode, coarser: int, *, only_size: bool) -> ChunkLayers:
        """Layers of a mode at a step; where only sizes matter, scatterers may be those of a step near by."""
        if mode.with_rank:
            return self._with_rank(step, coarser, only_size=only_size)
        if not mode.with_points or self.layers is None:
            return replace(self._plain, step=step, stream=Encoder())
        before = self._counted_points
        if not only_size or before is None or abs(math.log(step / before.step)) > NEAR:
            before = self._points(step, only_size=only_size)
            self._counted_points = before if only_size else self._counted_points
        return before

    def exact(self, values: CubeValues) -> bytes:
        """The chunk without any loss, as float32."""
        front = PREFIX.pack(
            self.frames.num_frames, 0, self.peak, 1.0, 0, 0, _noise_level(self.noise_power), 0, 0, IS_EXACT
        )
        return front + pack_exact(values)

    def sample(self, choice: TransformChoice) -> CellSample:
        """Some coefficients of a transform of the frames themselves, for estimates."""
        if choice not in self._samples:
            transform = self._transform(choice)
            front = PREFIX.size + len(transform.packed)
            if choice.antenna_klt:  # changes the coefficients of a cell, but not its power
                turn = transform.antennas @ self.beams.conj().T
                found = self.sample(replace(choice, antenna_klt=False)).turned(turn, front)
            else:
                _, coefficients = self._transformed(choice, self._plain)
                found = CellSample.of(coefficients, transform.spread(self.is_active), front)
            self._samples[choice] = found
        return self._samples[choice]

    def noise_sample(self) -> CellSample:
        """Some coefficients of the noise layer, for estimates."""
        if self._noise_sample is None:
            quiet = np.where(self.is_active[..., None], np.complex64(0), self.target)  # holes matter little here
            coefficients = to_noise(quiet, self.beams)
            self._noise_sample = CellSample.of(coefficients, np.ones(coefficients.shape[1:], bool))
        return self._noise_sample

    def sample_as_noise(self) -> CellSample:
        """Some coefficients of a noise layer of everything, for estimates."""
        if self._whole_sample is None:
            coefficients = self._all_as_noise
            self._whole_sample = CellSample.of(coefficients, np.ones(coefficients.shape[1:], bool), PREFIX.size)
        return self._whole_sample

    def _noise_layer(self, mode: ChunkMode, target: np.ndarray, *, only_size: bool) -> NoiseLayer:
        """The noise after the layers of a mode; coded once, for layers change little with the step."""
        if self._noise is None or self._noise[:2] != (mode, only_size):
            layers = replace(mode, noise_step=0.0)
            if layers not in self._quiet:
                self._quiet[layers] = to_noise(without_signal(target, self.is_active), self.beams)
            layer = NoiseLayer.of(self._quiet[layers], mode.noise_step, self.beams, only_size=only_size)
            self._noise = mode, only_size, layer
        return self._noise[2]

    def _with_rank(self, step: float, coarser: int, *, only_size: bool) -> ChunkLayers:
        if self._components is None:
            self._components = components_of(self.target)
        noise_power = self.noise_power * (1 - 1 / (coarser or 4) ** 2)
        factors = RankFactors.of_components(self._components, self.target.shape, step, noise_power)
        if factors is None:
            return replace(self._plain, step=step, stream=Encoder())
        stream, uncoded_bytes = Encoder(), 0.0
        if only_size and (self._rank_bits is not None or not factors.is_peaked):
            uncoded_bytes = (self._rank_bits or USUAL_RANK_BITS) * factors.estimated_bits() / 8
        else:
            factors.code(stream)
            self._rank_bits = 8 * len(stream.to_bytes()) / max(factors.estimated_bits(), 1.0)
        return ChunkLayers(
            step=step, target=(self.target - factors.values(step, self.target.shape)).astype(self.target.dtype),
            near=self._plain.near, stream=stream, flags=HAS_RANK, uncoded_bytes=uncoded_bytes, rank=factors.rank,
            num_values=factors.num_values,
        )  # fmt: skip

    def _transformed(self, choice: TransformChoice, layers: ChunkLayers) -> tuple[ChunkTransform, np.ndarray]:
        if choice not in layers.transformed:
            is_plain = layers.target is self.target
            transform = self._transform(choice) if is_plain else ChunkTransform.of(choice, layers.target, self.beams)
            layers.transformed[choice] = transform, transform.forward(layers.target)
        return layers.transformed[choice]

    def _transform(self, choice: TransformChoice) -> ChunkTransform:
        """The transform of a choice that suits the frames; matrices are the same whatever the DCTs."""
        key = choice.antenna_klt, choice.doppler_klt
        if key not in self._transforms:
            self._transforms[key] = ChunkTransform.of(choice, self.target, self.beams)
        return self._transforms[key].over(choice)

    def _points(self, step: float, *, only_size: bool) -> ChunkLayers:
        """Static layer and scatterers; with `only_size` they are counted, once some have been coded."""
        assert self.layers is not None
        window, stream = self.frames.fit_window(), Encoder()
        layers = self.layers
        with torch.inference_mode():
            static = static_levels(layers.static, window, self.beams, step)
            layers = replace(layers, static=static_of(static, window, self.beams, step))
            steps = PointSteps.of(step, window.response, window.axes)
            points = self._refined(layers, window, steps)
            coded = quantize(points, steps, window.axes, window.response.num_directions, LEAST_SIZE)
            layers = replace(layers, points=_dequantize(coded, window, steps))
            target = self.target - rendered(layers, window.response, window.axes).numpy()
        uncoded_bytes, point_bits = 0.0, uniform_bits(coded, steps, window.response.num_directions)
        if only_size and self._adaptive_bits is not None:
            uncoded_bytes = (static_bits(static) + point_bits + self._adaptive_bits * len(coded)) / 8
        else:
            if static.any():
                code_static(stream, static)
            before = len(stream.to_bytes())
            if len(coded):
                _point_coder(self.frames, window, steps).code(stream, coded)
                self._adaptive_bits = (8 * (len(stream.to_bytes()) - before) - point_bits) / len(coded)
        has_gains = bool((layers.calibration != 1).any())
        return ChunkLayers(
            step=step, target=target, near=nearness(coded, self.target.shape[:3]), stream=stream,
            flags=HAS_STATIC * bool(static.any()) + HAS_POINTS * bool(len(coded)) + HAS_GAINS * has_gains,
            front=_pack_gains(layers.calibration) if has_gains else b"", uncoded_bytes=uncoded_bytes,
            num_values=int(np.count_nonzero(static)) + len(coded) * values_of_point(window.response),
        )  # fmt: skip

    def _refined(self, layers: Layers, window: FitWindow, steps: PointSteps) -> Points:
        """The scatterers worth coding, refined without the others."""
        count = int((layers.points.amplitude.abs() / steps.amplitude >= LEAST_SIZE).sum())
        kept = strongest(layers.points, count)
        if not count or count >= KEPT_SHARE * int((layers.points.amplitude != 0).sum()):
            return kept
        if self._refined_points is not None and abs(self._refined_points[0] / count - 1) < SAME_COUNT:
            return self._refined_points[1]
        target = torch.from_numpy(self.target) / layers.calibration
        target = target - static_cells(layers.static, window.response, window.axes)
        damping = Damping.fresh(len(target))
        points = refined(kept, target, window.response, window.axes, damping, steps=REFINED_STEPS, largest=160)[0]
        self._refined_points = count, points
        return points


def decode_chunk(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes a chunk; without the residual, only its layers. Raises InputError for a malformed chunk."""
    try:
        return _decode(data, config, with_residual)
    except (ValueError, IndexError, struct.error, AssertionError, OverflowError, np.linalg.LinAlgError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"a chunk of the .mmw file is malformed ({error}); compress the recording again") from None


def finite(values: np.ndarray) -> np.ndarray:
    """The values of a chunk. Raises InputError where steps or peak were so large that some are not finite."""
    if not np.isfinite(values).all():
        raise InputError("a chunk of the .mmw file holds values that are not finite; compress the recording again")
    return values


def _decode(data: bytes, config: RadarConfig, with_residual: bool) -> DecodedChunk:
    num_frames, hop, peak, step, one, more, noise, coarse, rank, flags = PREFIX.unpack_from(data)
    coarser, finer, version = unpack_steps(coarse, is_version_3=not flags & IS_NEW)
    if not (num_frames and step > 0 and math.isfinite(step) and math.isfinite(peak)):
        raise ValueError("impossible prefix")
    if bool(flags & HAS_RANK) != bool(rank):
        raise ValueError("impossible flags")
    cells = config.num_range_bins * config.num_loops * config.num_antennas
    if (num_frames > 1 and num_frames * cells > MOST_VALUES) or cells > MOST_CELLS:
        raise ValueError("more values than any chunk has")
    frames = ChunkFrames.of(config, num_frames, hop)
    noise_power = 10 ** (-noise / 20)
    if flags & IS_EXACT:
        shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
        values = unpack_exact(data[PREFIX.size :], shape)
        return DecodedChunk(frames=frames, layers=None, residual=None, peak=peak, noise_power=noise_power, exact=values)
    at, beams, shape = PREFIX.size, beams_of(config), frames.working_shape
    gains, transform = torch.ones(config.num_antennas, dtype=torch.complex64), None
    if flags & HAS_GAINS:
        gains = _unpack_gains(data[at : at + 2 * config.num_antennas])
        at += 2 * config.num_antennas
    noise: NoiseLayer | None = None
    if flags & HAS_NOISE:
        noise = NoiseLayer.unpack(data[at:], shape, beams, version=version)
        at += len(noise.packed)
    if flags & HAS_CELLS:
        transform = ChunkTransform.unpack(data[at:], beams, shape[2])
        at += len(transform.packed)
    stream = Decoder(data[at:], version=version)
    layers, near = _decode_layers(stream, frames, step, flags, gains, noise_power)
    parts: list[np.ndarray] = []
    if flags & HAS_RANK:
        parts.append(_decode_rank(stream, rank, shape, step))
    if noise is not None and with_residual:
        parts.append(noise.values)
    num_values = 0
    if transform is not None and with_residual:
        classes = np.zeros(shape[:3], np.int64)
        levels = code_cells(stream, None, classes, near, transform.correlated, coarser, shape[3])
        num_values = int(np.count_nonzero(levels))
        cells = QuantizedCells(levels=levels, classes=classes, centroids=(one, more))
        parts.append(transform.inverse(cells.values(step, coarser)))
    if finer > 1 and with_residual:
        parts.append(decoded_moving(stream, shape, beams, step / finer))
    return DecodedChunk(
        frames=frames, layers=layers, residual=finite(reduce(np.add, parts)) if parts else None, peak=peak,
        noise_power=noise_power, num_residual_values=num_values, rank=rank, has_noise=noise is not None, step=step,
        transform=None if transform is None else transform.choice,
    )  # fmt: skip


def _decode_layers(stream, frames: ChunkFrames, step: float, flags: int, gains: Tensor, noise_power: float):
    """Layers, or None where there are none; nearness of scatterers."""
    near = np.zeros(frames.working_shape[:3], np.int64)
    if not flags & (HAS_STATIC | HAS_POINTS):
        return None, near
    window = frames.fit_window()
    static = np.zeros((2, frames.config.num_antennas, 1, frames.config.num_range_bins, 1), np.int64)
    if flags & HAS_STATIC:
        code_static(stream, static)
    points = no_points(window.num_working_frames)
    if flags & HAS_POINTS:
        steps = PointSteps.of(step, window.response, window.axes)
        coded = _point_coder(frames, window, steps).code(stream, None)
        points, near = _dequantize(coded, window, steps), nearness(coded, frames.working_shape[:3])
    layers = Layers(
        points=points, static=static_of(static, window, beams_of(frames.config), step), calibration=gains,
        noise_power=noise_power,
    )  # fmt: skip
    return layers, near


def _decode_rank(stream: BitStream, rank: int, shape: tuple[int, int, int, int], step: float) -> np.ndarray:
    if rank > min(shape[0] * shape[1], shape[2] * shape[3]):
        raise ValueError("impossible rank")
    factors = RankFactors.empty(rank, shape)
    factors.code(stream)
    return factors.values(step, shape).astype(np.complex64)


def _point_coder(frames: ChunkFrames, window: FitWindow, steps: PointSteps) -> PointCoder:
    config, response = frames.config, window.response
    moves = round(256 * config.frame_period_s * response.velocity_a_bin_mps / response.range_a_bin_m)
    return PointCoder(frames.working_shape[:3], steps, response.num_directions, moves)


def _dequantize(coded, window: FitWindow, steps: PointSteps) -> Points:
    return dequantize(coded, window.num_working_frames, steps, window.axes, window.response.num_directions)


def _noise_level(power: float) -> int:
    """Noise power in half decibels below the peak power."""
    return int(np.clip(round(-20 * math.log10(max(power, 1e-12))), 0, 255))


def _pack_gains(gains: Tensor) -> bytes:
    parts = torch.stack([gains.abs().log2() * GAIN_STEPS, gains.angle() / (2 * math.pi) * 256])
    parts[0] = parts[0].round().clamp(-128, 127)
    return (parts.round().to(torch.int16) & 255).to(torch.uint8).numpy().tobytes()


def _unpack_gains(data: bytes) -> Tensor:
    parts = torch.from_numpy(np.frombuffer(data, np.int8).astype(np.float32).reshape(2, -1))
    return torch.polar(2 ** (parts[0] / GAIN_STEPS), parts[1] / 256 * 2 * math.pi)


def _quantize_gains(gains: Tensor) -> Tensor:
    return gains if bool((gains == 1).all()) else _unpack_gains(_pack_gains(gains))
