"""Assumptions that a run reports."""


class UsualAssumption(str):
    """An assumption that applies to every ordinary run; the command line prints it only with --verbose."""
