"""The geometry of a room: gravity, surfaces, walls, doors, windows, and what they are made of."""
