"""What is no test."""

collect_ignore = ["sionna_halo.py"]  # a script of test_second_order.py, which imports sionna
