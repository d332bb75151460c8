"""Turns a sentence into the motion of 22 joints, placed in a Scene."""
