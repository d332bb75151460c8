"""Parses a sentence into a plan: steps with activities, directions, counts and times."""
