"""Recordings of real radars: reading, plausibility checks and processing."""
