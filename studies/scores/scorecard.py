"""All scores of a cube against the ground truth, each with its baselines: the one way to report a comparison."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.core.shapes import RangeAngleMap, RangeDopplerMap, RangeDopplerMask
from mmweaver.evaluation.map_scores import log_map_difference_db
from mmweaver.signal.points import ca_cfar, point_cloud
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power, range_doppler_power
from studies.scores.cloud_distances import cloud_distances_m
from studies.scores.cube_scores import (
    BASELINES,
    Cells,
    antenna_phase_error_rad,
    cells_of,
    complex_ssim,
    nmse_db,
    peak_of,
    psnr_db,
    span_of,
)
from studies.scores.map_similarity import log_map_ssim


class Representations:
    """Maps, masks and points of a cube that metrics compare, each computed once."""

    def __init__(self, cube: RadarCube):
        self.cube = cube
        self.values = cube.values

    @cached_property
    def range_doppler(self) -> RangeDopplerMap:
        return range_doppler_power(self.cube)

    @cached_property
    def range_azimuth(self) -> RangeAngleMap:
        return range_azimuth_power(self.cube, azimuth_axis_rad())

    @cached_property
    def cells(self) -> Cells:
        return cells_of(self.cube)

    @cached_property
    def is_detected(self) -> RangeDopplerMask:
        return ca_cfar(self.range_doppler, num_looks=self.values.shape[-1]).is_detected

    @cached_property
    def points(self) -> PointCloud:
        return point_cloud(self.cube)

    @cached_property
    def peak(self) -> float:
        return peak_of(self.values)

    @cached_property
    def span(self) -> float:
        return span_of(self.values)


@dataclass(frozen=True, kw_only=True)
class Metric:
    """One metric: unit, definition, perfect value, and whether it may serve as a headline.

    `is_headline` is False where all zeros score nearly as well as a good model on sparse radar cubes.
    """

    unit: str
    definition: str
    perfect: float
    is_headline: bool
    score: Callable[[Representations, Representations], float]
    version: int = 1


def _cloud(which: int) -> Callable[[Representations, Representations], float]:
    def score(prediction: Representations, truth: Representations) -> float:
        num_frames, missing_m = len(truth.values), float(truth.cube.grid.range_m[-1])
        return cloud_distances_m(prediction.points, truth.points, num_frames=num_frames, missing_m=missing_m)[which]

    return score


METRICS: Mapping[str, Metric] = {
    "nmse_db": Metric(
        unit="dB",
        definition="energy of the error over energy of the truth, all cells",
        perfect=-math.inf,
        is_headline=True,
        score=lambda p, t: nmse_db(p.values, t.values),
    ),
    "nmse_active_db": Metric(
        unit="dB",
        definition="the same over active cells: truth more than 12 dB above its median power",
        perfect=-math.inf,
        is_headline=True,
        score=lambda p, t: nmse_db(p.values, t.values, t.cells.is_active),
    ),
    "nmse_moving_db": Metric(
        unit="dB",
        definition="the same over moving cells: active ones outside zero Doppler and its two neighbours",
        perfect=-math.inf,
        is_headline=True,
        score=lambda p, t: nmse_db(p.values, t.values, t.cells.is_moving),
    ),
    "psnr_db": Metric(
        unit="dB",
        definition="mean squared error of I and Q against the square of the truth's largest |I| or |Q|",
        perfect=math.inf,
        is_headline=False,
        score=lambda p, t: psnr_db(p.values, t.values, peak=t.peak),
    ),
    "cssim": Metric(
        unit="1",
        definition="mean SSIM of I and Q range-Doppler maps, 11x11 Gaussian, data range = span of the truth's I and Q",
        perfect=1.0,
        is_headline=False,
        score=lambda p, t: complex_ssim(p.values, t.values, data_range=t.span),
    ),
    "rd_ssim": Metric(
        unit="1",
        definition="SSIM of 50 dB range-Doppler pictures over the cells where either shows something",
        perfect=1.0,
        is_headline=True,
        score=lambda p, t: log_map_ssim(p.range_doppler, t.range_doppler),
    ),
    "rd_difference_db": Metric(
        unit="dB",
        definition="absolute difference of the same pictures, all cells, per cell that the truth shows",
        perfect=0.0,
        is_headline=True,
        score=lambda p, t: log_map_difference_db(p.range_doppler, t.range_doppler),
    ),
    "ra_ssim": Metric(
        unit="1",
        definition="as rd_ssim, of range-azimuth pictures",
        perfect=1.0,
        is_headline=True,
        score=lambda p, t: log_map_ssim(p.range_azimuth, t.range_azimuth),
    ),
    "ra_difference_db": Metric(
        unit="dB",
        definition="as rd_difference_db, of range-azimuth pictures",
        perfect=0.0,
        is_headline=True,
        score=lambda p, t: log_map_difference_db(p.range_azimuth, t.range_azimuth),
    ),
    "rd_ssim_all_cells": Metric(
        unit="1",
        definition="as rd_ssim, cells that are empty in both counted too",
        perfect=1.0,
        is_headline=False,
        score=lambda p, t: log_map_ssim(p.range_doppler, t.range_doppler, all_cells=True),
    ),
    "ra_ssim_all_cells": Metric(
        unit="1",
        definition="as ra_ssim, cells that are empty in both counted too",
        perfect=1.0,
        is_headline=False,
        score=lambda p, t: log_map_ssim(p.range_azimuth, t.range_azimuth, all_cells=True),
    ),
    "antenna_phase_error_rad": Metric(
        unit="rad",
        definition="mean absolute error of the phase step between neighbouring antennas at cells detected in the truth"
        " (CA-CFAR, 1e-4)",
        perfect=0.0,
        is_headline=True,
        score=lambda p, t: antenna_phase_error_rad(p.values, t.values, t.is_detected),
    ),
    "hausdorff_m": Metric(
        unit="m",
        definition="Hausdorff distance of the point clouds, mean over frames; an empty cloud counts the far range",
        perfect=0.0,
        is_headline=True,
        score=_cloud(0),
    ),
    "chamfer_m": Metric(
        unit="m",
        definition="Chamfer distance (mean of both directions, unsquared) of the point clouds, mean over frames",
        perfect=0.0,
        is_headline=True,
        score=_cloud(1),
    ),
}

Scores = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class Scorecard:
    """All metrics of a prediction and of the baselines; `data_range` holds the peak and span used by PSNR and cSSIM.

    `oracle` scores another realization of the same pose and room with other surface micro-phases: the best possible
    without knowing those.
    """

    prediction: Scores
    baselines: dict[str, Scores]
    oracle: Scores | None
    data_range: dict[str, float]

    def as_json(self) -> dict:
        """{metric: {value, unit, definition, version, is_headline, baseline: {...}, oracle: {realization}}}.

        A value that is not finite (a perfect score in dB, or an undefined one) is None.
        """
        rows = {}
        for name, metric in METRICS.items():
            rows[name] = {
                "value": _finite(self.prediction[name]),
                "unit": metric.unit,
                "definition": metric.definition,
                "version": metric.version,
                "is_headline": metric.is_headline,
                "baseline": {baseline: _finite(scores[name]) for baseline, scores in self.baselines.items()},
            }
            if self.oracle is not None:
                rows[name]["oracle"] = {"realization": _finite(self.oracle[name])}
        rows["psnr_db"]["peak"] = self.data_range["peak"]
        rows["cssim"]["data_range"] = self.data_range["span"]
        return rows


def scorecard(prediction: RadarCube, truth: RadarCube, *, oracle: RadarCube | None = None) -> Scorecard:
    """Scores a cube against the ground truth, always with its baselines.

    `oracle`: another realization of the same scene. Raises InputError where the cubes have different cells, the ground
    truth is all zeros or the prediction is not finite.
    """
    for cube, name in ((prediction, "prediction"), (truth, "ground truth"), *([(oracle, "oracle")] if oracle else [])):
        if cube.values.shape != truth.values.shape:
            raise InputError(
                f"the {name} has shape {cube.values.shape}, the ground truth {truth.values.shape};"
                " sample both on the same grid"
            )
        if not np.isfinite(cube.values).all():
            raise InputError(f"the {name} holds values that are not finite")
    if not truth.values.any():
        raise InputError("the ground truth is all zeros; there is nothing to score against")
    reference = Representations(truth)
    return Scorecard(
        prediction=_scores(prediction, reference),
        baselines={name: _scores(predict(truth), reference) for name, predict in BASELINES.items()},
        oracle=None if oracle is None else _scores(oracle, reference),
        data_range={"peak": reference.peak, "span": reference.span},
    )


def _scores(prediction: RadarCube, truth: Representations) -> Scores:
    candidate = Representations(prediction)
    return {name: metric.score(candidate, truth) for name, metric in METRICS.items()}


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
