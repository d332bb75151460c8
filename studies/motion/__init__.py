"""Sentences and motions against text corpora and motion capture."""
