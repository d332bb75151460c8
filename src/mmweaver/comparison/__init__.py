"""Two radar signals against each other: features with their spread, point clouds, and what tells one from the other."""
