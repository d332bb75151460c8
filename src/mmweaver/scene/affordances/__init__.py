"""What a person can do where: seats, landmarks, free floor."""
