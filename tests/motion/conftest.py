"""Lets the tests of this room import the scenes made for them (rooms.py)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
