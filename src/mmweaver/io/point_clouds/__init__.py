"""Point clouds as boards and public data sets store them."""
