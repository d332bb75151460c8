"""Other people's recorded motion, read from files and placed in the room. Start at `read.py`."""
