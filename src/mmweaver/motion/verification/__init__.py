"""Verification: what a motion does, measured on its joints, against what its sentence asks for."""
