"""Hostile input for every reader: `make fuzz SECONDS=600`, and a bounded number of cases in `make test`."""
