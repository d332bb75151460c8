"""The studio: a page in the browser to generate, play, compare and export radar data."""
