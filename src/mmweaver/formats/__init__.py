"""Files other people use: recordings and radar set-ups."""
