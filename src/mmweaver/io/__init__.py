"""Third-party file formats of recordings and radar configurations, and the project's own .npz files."""
