"""Recordings by real radars: read, processed, and used as examples."""
