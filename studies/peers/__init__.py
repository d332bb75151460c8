"""Other signal generators on the same work."""
