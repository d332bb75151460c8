"""The geometry of a room: gravity, surfaces, walls, doors, windows, and their materials."""
