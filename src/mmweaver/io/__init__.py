"""File formats of recordings and radar configurations, including the project's own .npz files."""
