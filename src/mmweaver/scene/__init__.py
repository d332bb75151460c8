"""A photo with depth in, the room it shows out."""
