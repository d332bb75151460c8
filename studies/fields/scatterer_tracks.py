"""Do scatterers that persist over frames represent a signal better, for the same number of parameters?

python -m studies run scatterer_tracks

A track over L frames has a polynomial of time for its range (the slope is the Doppler) and its direction cosines, and
an amplitude per frame. It starts at a scatterer of the middle frame; then all tracks are fitted jointly
(Levenberg-Marquardt with the full Jacobian). Baselines: as many parameters in free points of each frame, and the free
points that the tracks start from.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.dsp.point_response import PointResponse, Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted
from mmweaver.fields.scatterers.layers import values_of_point
from studies.fields.field_signals import SIGNALS
from studies.manifest import StudyRun

EXPERIMENT = "scatterer_tracks"
SIGNAL = "walking_alone"
FIRST_FRAMES = (3, 12)
POINTS_A_FRAME = 24
STEPS = 40
NUDGE = 1e-3  # of a bin or a direction cosine, for the derivatives
MARGIN_BINS = 3


@dataclass(frozen=True, kw_only=True)
class TrackShape:
    """Tracks over so many frames; degrees of the polynomials of range and of the two direction cosines."""

    num_frames: int
    range_degree: int
    direction_degree: int

    @property
    def num_geometry(self) -> int:
        return self.range_degree + 1 + 2 * (self.direction_degree + 1)

    @property
    def num_values(self) -> int:
        """Of one track, complex amplitudes of all frames included."""
        return self.num_geometry + 2 * self.num_frames


SHAPES = (
    TrackShape(num_frames=2, range_degree=1, direction_degree=0),
    TrackShape(num_frames=2, range_degree=1, direction_degree=1),
    TrackShape(num_frames=4, range_degree=2, direction_degree=1),
)


class _Tracks:
    """Geometry (number, track) in bins and cosines, at times in frames from the middle."""

    def __init__(self, shape: TrackShape, response: PointResponse, frame_s: float, start: Points):
        self.shape, self.response = shape, response
        self.time = torch.arange(shape.num_frames) - (shape.num_frames - 1) / 2
        self.bins_a_frame = response.velocity_a_bin_mps * frame_s / response.range_a_bin_m  # for one Doppler bin
        count = start.amplitude.shape[-1]
        self.geometry = torch.zeros(shape.num_geometry, count)
        late = float(self.time[shape.num_frames // 2])
        own_range = start.range_bin[0] - response.coupling * start.doppler_bin[0]
        self.geometry[0] = own_range - late * self.bins_a_frame * start.doppler_bin[0]
        self.geometry[1] = self.bins_a_frame * start.doppler_bin[0]
        self.geometry[shape.range_degree + 1] = start.direction[0, :, 0]
        self.geometry[shape.range_degree + 1 + shape.direction_degree + 1] = start.direction[0, :, 1]

    def points(self, geometry: Tensor, frame: int) -> Points:
        """Unit points of one frame, (track, 1)."""
        shape, at = self.shape, float(self.time[frame])
        degree = shape.range_degree
        range_bin = sum((geometry[power] * at**power for power in range(degree + 1)), torch.zeros(()))
        slope = sum((power * geometry[power] * at ** (power - 1) for power in range(1, degree + 1)), torch.zeros(()))
        doppler_bin = slope / self.bins_a_frame
        sides = geometry[degree + 1 :].unflatten(0, (2, shape.direction_degree + 1))
        power = torch.tensor([at**n for n in range(shape.direction_degree + 1)])
        direction = (sides * power[:, None]).sum(dim=1).clamp(-1, 1)
        return Points(
            range_bin=(range_bin + self.response.coupling * doppler_bin)[:, None],
            doppler_bin=doppler_bin[:, None],
            direction=direction.T[:, None, :],
            amplitude=torch.ones(geometry.shape[1], 1, dtype=torch.complex64),
        )


def fit_tracks(target: Tensor, fit_window: FitWindow, shape: TrackShape, frame_s: float, start: Points) -> float:
    """Energy of the residual of the target (frame, range, doppler, antenna) over that of the target."""
    axes = fit_window.axes
    tracks = _Tracks(shape, fit_window.response, frame_s, start)

    def unit(geometry: Tensor) -> Tensor:
        """(frame, track, cell)."""
        every = [fit_window.response.render(tracks.points(geometry, frame), axes) for frame in range(shape.num_frames)]
        return torch.stack(every)[:, :, rows, columns_seen].flatten(2)

    rows, columns_seen = _with_signal(target, 1), _with_signal(target, 2)
    wanted = target[:, rows, columns_seen].flatten(1)
    total, damping = float(target.abs().square().sum()), 1e-2
    columns = unit(tracks.geometry)
    amplitude, left = _amplitudes(columns, wanted)
    for _ in range(STEPS):
        step = _geometry_step(tracks.geometry, unit, columns, amplitude, left, damping)
        trial = tracks.geometry + step
        trial_columns = unit(trial)
        trial_amplitude, trial_left = _amplitudes(trial_columns, wanted)
        if float(trial_left.abs().square().sum()) < float(left.abs().square().sum()):
            tracks.geometry, columns, amplitude, left = trial, trial_columns, trial_amplitude, trial_left
            damping = max(damping / 4, 1e-6)
        else:
            damping = min(damping * 6, 1e3)
    outside = total - float(wanted.abs().square().sum())
    return (float(left.abs().square().sum()) + outside) / total


def _with_signal(target: Tensor, axis: int) -> slice:
    """Cells of an axis that hold nearly all of the energy, with neighbours; others only cost memory."""
    energy = target.abs().square().sum([other for other in range(4) if other != axis])
    strong = torch.nonzero(energy > 1e-4 * energy.max())[:, 0]
    return slice(max(0, int(strong[0]) - MARGIN_BINS), int(strong[-1]) + MARGIN_BINS + 1)


def _amplitudes(columns: Tensor, wanted: Tensor) -> tuple[Tensor, Tensor]:
    """Least-squares amplitudes (frame, track), and the residual (frame, cell)."""
    normal = columns.conj() @ columns.transpose(1, 2)
    ridge = 1e-6 * normal.diagonal(dim1=1, dim2=2).real.amax(dim=1)
    normal = normal + ridge[:, None, None] * torch.eye(normal.shape[-1])
    amplitude = torch.linalg.solve(normal, (columns.conj() @ wanted[..., None]))[..., 0]
    return amplitude, wanted - (amplitude[:, None, :] @ columns)[:, 0]


def _geometry_step(geometry: Tensor, unit, columns: Tensor, amplitude: Tensor, left: Tensor, damping: float) -> Tensor:
    """Damped Gauss-Newton step of the geometry with the amplitudes free (their columns are projected out)."""
    count = geometry.shape[1]
    parts = []
    for index in range(len(geometry)):
        nudge = torch.zeros_like(geometry)
        nudge[index] = NUDGE
        slope = (unit(geometry + nudge) - unit(geometry - nudge)) / (2 * NUDGE)
        parts.append(slope * amplitude[..., None])
    jacobian = torch.stack(parts, dim=1).flatten(1, 2)  # frame, (number, track), cell
    basis = torch.linalg.qr(columns.transpose(1, 2)).Q
    jacobian = jacobian - (jacobian @ basis.conj()) @ basis.transpose(1, 2)
    normal = (jacobian.conj() @ jacobian.transpose(1, 2)).real.sum(0)
    gradient = (jacobian.conj() @ left[..., None]).real.sum(0)[:, 0]
    scale = (normal.diagonal() + 1e-6 * normal.diagonal().max()).rsqrt()
    scaled = normal * scale[:, None] * scale[None] + damping * torch.eye(len(normal))
    step = torch.linalg.solve(scaled, gradient * scale) * scale
    return step.view(len(geometry), count).clamp(-0.5, 0.5).to(geometry.dtype)


def compare(target: Tensor, fit_window: FitWindow, shape: TrackShape, frame_s: float) -> dict[str, float]:
    """Errors in dB over the same frames: free points, tracks with as many parameters, and the number of each."""
    recipe = FitRecipe(num_points=POINTS_A_FRAME * shape.num_frames, with_static=False, least_gain=0.0)
    free = fitted(target, fit_window, recipe)
    each = values_of_point(fit_window.response)
    num_values = int(free.counts().sum()) * each
    num_tracks = num_values // shape.num_values
    middle = target[shape.num_frames // 2 :][:1]
    one = FitRecipe(num_points=num_tracks, with_static=False, least_gain=0.0)
    start = fitted(middle, FitWindow.of(fit_window.config, 1, 0), one).points
    left = target - fit_window.response.render(free.points, fit_window.axes)
    return {
        "free_points_db": _db(float(left.abs().square().sum() / target.abs().square().sum())),
        "tracks_db": _db(fit_tracks(target, fit_window, shape, frame_s, start)),
        "values": num_values,
        "tracks": start.amplitude.shape[1],
    }


def _db(ratio: float) -> float:
    return float(10 * np.log10(ratio))


def measure(run: StudyRun) -> Path:
    """One row a shape of track, means over a few positions in the sequence."""
    signal = SIGNALS[SIGNAL](None)
    cube = signal.noise_free
    assert cube is not None
    rows: list[dict[str, Any]] = []
    for shape in SHAPES:
        start = time.process_time()
        found = []
        for first in FIRST_FRAMES:
            fit_window = FitWindow.of(cube.config, shape.num_frames, 0)
            values = cube.values[first : first + shape.num_frames]
            working = fit_window.working(values / np.abs(values).max())
            found.append(compare(working, fit_window, shape, cube.config.frame_period_s))
        rows.append(_row(signal.digest, shape, found, time.process_time() - start))
    config = {"first_frames": list(FIRST_FRAMES), "points_a_frame": POINTS_A_FRAME, "steps": STEPS}
    return run.write(EXPERIMENT, "tracks", config=config, rows=rows)


def _row(digest: str, shape: TrackShape, found: list[dict[str, float]], seconds: float) -> dict[str, Any]:
    tracks, free = (float(np.mean([each[name] for each in found])) for name in ("tracks_db", "free_points_db"))
    definition = "energy of the error over energy of the truth, all cells of the frames, mean over the places"
    return {
        "dataset": {"name": SIGNAL, "origin": "simulated, without noise", "sha256": digest},
        "n": len(found),
        "seeds": [0],
        "seconds": {"all": round(seconds, 2)},
        "frames": shape.num_frames,
        "range_degree": shape.range_degree,
        "direction_degree": shape.direction_degree,
        "values_of_track": shape.num_values,
        "metrics": {
            "nmse_db": {
                "value": tracks, "unit": "dB", "definition": definition, "version": 1, "is_headline": True,
                "baseline": {"zeros": 0.0, "free_points": free},
            }
        },
        "places": found,
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    """This study has no options of its own."""


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run)
