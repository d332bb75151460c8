"""Mentions and steps as sequences: which mention is shown by which step, in order or in any."""

from collections.abc import Sequence
from functools import cache

Slots = Sequence[Sequence[frozenset[int]]]  # of each step: the mentions that each of its slots can show


def shown_in_order(mentions: int, slots: Slots) -> dict[int, int]:
    """{mention: step} for as many mentions as can be shown by steps in the same order, each slot by one.

    Within a step the order does not count: its slots are at once.
    """

    @cache
    def best(mention: int, step: int, used: int) -> tuple[tuple[int, int], ...]:
        if mention == mentions or step == len(slots):
            return ()
        chosen = best(mention, step + 1, 0)
        for k, fitting in enumerate(slots[step]):
            if mention in fitting and not used >> k & 1:
                found = ((mention, step), *best(mention + 1, step, used | 1 << k))
                chosen = max(found, chosen, key=len)
        return max(chosen, best(mention + 1, step, used), key=len)

    return dict(best(0, 0, 0))


def shown_at_all(mentions: int, slots: Slots) -> dict[int, int]:
    """{mention: step} for as many mentions as can be shown by steps in any order, each slot by one."""
    every = [(step, fitting) for step, own in enumerate(slots) for fitting in own]
    taken: dict[int, int] = {}  # slot -> mention

    def takes(mention: int, tried: set[int]) -> bool:
        for k, (_, fitting) in enumerate(every):
            if mention in fitting and k not in tried:
                tried.add(k)
                if k not in taken or takes(taken[k], tried):
                    taken[k] = mention
                    return True
        return False

    for mention in range(mentions):
        takes(mention, set())
    return {mention: every[k][0] for k, mention in taken.items()}
