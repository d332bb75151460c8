"""How well continuous fields and codecs hold radar cubes."""
