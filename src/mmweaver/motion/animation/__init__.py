"""Steps along a path become joints: the activity library and the kinematics."""
