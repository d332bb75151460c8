"""Scores that training, comparisons and recognisers report."""
