"""The activities, one kind per file: each writes Controls over the times of its StepContext."""
