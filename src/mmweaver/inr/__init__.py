"""Implicit neural representations of radar sequences: the paper's networks, and fields fitted to a signal.

    cube --fit--> field --sample, on_grid, jitter--> signal at any coordinates

Reference: paper, section "INR for RF representation"; docs/fields.md.
"""

from mmweaver.inr.fitting import FIELDS, PAPER, FitOptions, fit, fit_many
from mmweaver.inr.inr_field import InrField, load
from mmweaver.inr.networks import BaseINR, ModulatedINR, PositionalEncoding
from mmweaver.inr.separable import SeparableINR

__all__ = [
    "FIELDS",
    "PAPER",
    "BaseINR",
    "FitOptions",
    "InrField",
    "ModulatedINR",
    "PositionalEncoding",
    "SeparableINR",
    "fit",
    "fit_many",
    "load",
]
