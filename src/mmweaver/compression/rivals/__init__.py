"""Codecs of others that `.mmw` is compared with, behind one interface; most need the extra `codecs`."""
