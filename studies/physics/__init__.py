"""The simulator compared with recordings."""
