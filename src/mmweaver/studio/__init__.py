"""The studio: a page in the browser on which radar data is made, watched, compared and exported."""
