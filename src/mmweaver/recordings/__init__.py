"""Recordings by real radars: read and processed."""
