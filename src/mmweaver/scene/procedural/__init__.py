"""Procedural furnished rooms: mesh, ground truth, and the photo that a camera at the radar takes."""
