"""What is no test."""

collect_ignore = ["sionna_halo.py"]  # a script of test_body_room_paths.py, which imports sionna
