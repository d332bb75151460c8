"""Places for people: seats, landmarks, free floor."""
