"""The simulator against recordings."""
