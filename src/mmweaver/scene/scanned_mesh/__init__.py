"""A room scanned or modelled as a mesh, seen from the radar's position."""
