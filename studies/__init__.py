"""Everything the project measured: one study a file, results in results/, tables in docs/. Not part of the wheel."""
