"""The activities, one kind a file: each writes Controls over the times of its StepContext."""
