"""Baseline codecs behind one interface; they need the extra `codecs`."""
