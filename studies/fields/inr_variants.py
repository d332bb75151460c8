"""The INRs that the studies of fields compare: kind of field and options of its fit, by the names of their results."""

import time
from dataclasses import replace

from mmweaver.core.records import RadarCube
from mmweaver.inr import PAPER, FitOptions, InrField, fit_many

LAYERS = FitOptions(is_separable=False)
RELU = replace(LAYERS, activation="relu", encoded_share=None, learning_rate=2e-3)
INRS: dict[str, tuple[str, FitOptions]] = {
    "paper": ("modulated", PAPER),
    "paper_base": ("base", PAPER),
    "modulated": ("modulated", FitOptions()),
    "base": ("base", LAYERS),
    "smooth_short": ("modulated", LAYERS),
    "tuned_short": ("modulated", replace(LAYERS, encoded_share=None)),
    "siren_short": ("modulated", replace(LAYERS, activation="sine", encoded_share=0.0, learning_rate=2e-3)),
    "finer_short": ("modulated", replace(LAYERS, activation="finer", encoded_share=0.0, learning_rate=2e-3)),
    "wire_short": ("modulated", replace(LAYERS, activation="wire")),
    "relu_short": ("modulated", RELU),
    "raw_short": ("modulated", replace(RELU, is_centred=False)),
}


def fit_inr(cube: RadarCube, name: str, seed: int = 0) -> tuple[InrField, float]:
    """One of them fitted to a cube, and the CPU seconds of the fit."""
    kind, options = INRS[name]
    start = time.process_time()
    (field,) = fit_many([cube], kind, options=replace(options, seed=seed))
    return field, time.process_time() - start
