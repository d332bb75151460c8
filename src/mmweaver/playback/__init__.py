"""What a browser plays: a sequence and its room as typed arrays, and the page that shows them."""
