"""Geometry without radar: cameras, photos aligned with gravity, ray casting, rotations, body capsules."""
