"""Labelled data sets of activities in one's own rooms: the same places and people for every label."""
