"""What tools/make_sample_room.py renders: the room of the bundled sample, its patterns and its light."""
