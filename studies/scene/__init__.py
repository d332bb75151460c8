"""What is found in photographed rooms."""
