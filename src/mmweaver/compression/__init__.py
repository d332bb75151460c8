"""A radar cube in few bytes."""
