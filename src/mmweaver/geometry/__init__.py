"""Rays, pinhole cameras and planes: geometry that knows nothing of radars."""
