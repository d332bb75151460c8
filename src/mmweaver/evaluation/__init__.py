"""Scores, comparisons of signals and board calibration."""
