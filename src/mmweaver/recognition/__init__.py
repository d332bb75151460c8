"""Downstream recognisers that are trained on generated data."""
