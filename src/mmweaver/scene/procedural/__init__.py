"""Furnished rooms made from a seed: their mesh, their truth, and the photo that a camera at the radar takes."""
