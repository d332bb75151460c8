"""Recognisers trained on generated data, scored on recordings."""
