"""Animates steps along a path: the activity library and the kinematics."""
