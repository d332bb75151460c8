"""Reconstructs the room that a photo with depth shows."""
