"""Recorded motion, read from files and placed in the room. Start with `read_motion.py`."""
