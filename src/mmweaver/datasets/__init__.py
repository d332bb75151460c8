"""Data sets of made-up rooms: what is in one, how it is made, and how it is stored. Read `plan` first."""
