"""Fitting what is learned."""
