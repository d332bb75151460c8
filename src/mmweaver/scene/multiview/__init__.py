"""Several photos of one room, or a scan of it, fused to the whole room."""
