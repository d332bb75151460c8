"""ADC samples to cube, maps and points."""
