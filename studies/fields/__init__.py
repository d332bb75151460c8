"""How accurately continuous fields and codecs represent radar cubes."""
