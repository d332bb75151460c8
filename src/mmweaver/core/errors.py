"""The error for bad input, which the user can correct."""


class InputError(ValueError):
    """Bad input: one line on what was wrong and what to do about it.

    The command line prints it as it is and exits with status 2; anything else that is raised is a bug.
    """
