"""Codecs that ours is measured against, behind one interface; they need the extra `codecs`."""
