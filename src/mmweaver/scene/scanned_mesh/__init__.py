"""A room that was scanned or modelled as a mesh, seen from where the radar stands."""
