"""A radar cube as a continuous function, in few numbers."""
