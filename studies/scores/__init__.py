"""Scores of a radar cube against the ground truth, each with its baselines."""
