"""A sentence becomes a plan: steps with activities, directions, counts and times."""
