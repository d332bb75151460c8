"""Sentences and motions compared with text corpora and motion capture."""
