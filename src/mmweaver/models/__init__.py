"""The networks: encoders of room and motion, and what writes the field. Read `weaver_network` first."""
