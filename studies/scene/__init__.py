"""What is recognised in photographed rooms."""
