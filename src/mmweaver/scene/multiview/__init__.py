"""Several photos of one room, or a scan of it, joined to the whole room."""
