"""Mentions and steps as sequences: which mention is shown by which step, in order or in any."""

from collections.abc import Iterator, Sequence
from functools import cache

Slots = Sequence[Sequence[frozenset[int]]]  # of each step: the mentions that each of its slots can show

_OFTEN = {1: "once", 2: "twice"}


def not_shown_as_often(words: Sequence[str], kinds: Sequence[str], slots: Slots) -> Iterator[tuple[int, str]]:
    """(mention, what is said) for mentions that no slot of their own shows; `words` and `kinds` of each mention."""
    at_all = shown_at_all(len(words), slots)
    for i, (word, kind) in enumerate(zip(words, kinds, strict=True)):
        if i in at_all:
            continue
        times = sum(k in at_all for k, other in enumerate(kinds) if other == kind)
        if times:
            shown, said = (_OFTEN.get(n, f"{n} times") for n in (times, list(kinds).count(kind)))
            yield i, f"{word!r} is shown {shown}, not {said}"
        else:
            is_taken = any(i in fitting for own in slots for fitting in own)
            yield i, f"{word!r} {'has no movement of its own' if is_taken else 'is not shown'}"


def out_of_order(mentions: int, slots: Slots) -> int | None:
    """A mention that is shown, but not after the one before it; None where all that are shown are in order."""
    at_all, in_order = shown_at_all(mentions, slots), shown_in_order(mentions, slots)
    return None if len(in_order) == len(at_all) else next(i for i in at_all if i not in in_order)


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
