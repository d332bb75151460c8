"""A sentence becomes the motion of 22 joints, placed in a Scene."""
