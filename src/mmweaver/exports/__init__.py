"""Results in the layouts and containers that other people's tools read."""
