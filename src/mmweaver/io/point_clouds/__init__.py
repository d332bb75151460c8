"""Point clouds as stored by boards and public data sets."""
