"""The one error that a person caused and a person can mend."""


class InputError(ValueError):
    """Bad input: one line that says what was wrong and what to do.

    The command line prints it as it is and exits with status 2; anything else that is raised is a bug.
    """
