"""Photos with depth from the files of cameras, captures and models."""
