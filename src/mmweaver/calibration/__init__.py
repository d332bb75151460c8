"""What recordings tell of the board that made them: closed-form fits, each with what it could not see."""
