"""One file for each claim; every run writes results/<experiment>/<method>.json."""
