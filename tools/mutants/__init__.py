"""Breaks lines of the package one at a time and counts how many of them the tests of `make test` notice."""
