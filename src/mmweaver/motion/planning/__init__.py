"""Plans a path through the room, clear of furniture and of other people."""
