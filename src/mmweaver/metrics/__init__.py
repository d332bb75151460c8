"""Scores of a radar cube against the truth, each beside its floor."""
