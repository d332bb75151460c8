"""Sentences on what was assumed."""


class UsualAssumption(str):
    """An assumption that holds in every ordinary run; the command line prints it only with --verbose."""
