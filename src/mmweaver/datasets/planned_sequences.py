"""Sequences of a plan, computed for any range of rooms from counters, without those before them.

A room has four 64-bit words, hashed from (seed of the set, kind, layout): lighting and first activity, key of its
candidates, key of its seeds, number of its board. Candidate j performs the next of the twelve activities; person and
sentence follow from counter j. Candidates that combine two held-out properties are skipped, and sequence i gets the
64-bit seed of counter i. Two sequences of one room never share a seed; of ten million sequences in different rooms two
do with a probability of 3e-6.

Reference: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014 (the counters).
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import counter_bits, hashed_words

BLOCK_SEQUENCES = 50_000  # sequences computed at once, about 10 MB
COLUMNS = {"person": np.uint8, "activity": np.uint8, "text": np.uint8, "seed": np.uint64, "split": np.uint8}


@dataclass(frozen=True, kw_only=True)
class PlannedSequences:
    """Columns of the sequences in consecutive rooms, (room, sequence) each."""

    first: int  # number of the first room
    person: np.ndarray  # uint8, index of the person
    activity: np.ndarray  # uint8, index of the activity
    text: np.ndarray  # uint8, index among the sentences of the activity
    seed: np.ndarray  # uint64
    split: np.ndarray  # uint8, index of the split


@dataclass(frozen=True)
class RoomWords:
    """Random words of one room."""

    choices: int
    candidates: np.uint64
    seeds: np.uint64
    board: int

    @classmethod
    def of(cls, seed: int, kind: str, layout: int) -> "RoomWords":
        """Words of a room.

        Args:
            seed: Seed of the set.
            kind: Kind of room.
            layout: Number of the layout.
        """
        choices, candidates, seeds, board = hashed_words(int(seed), "dataset room", kind, layout)
        return cls(int(choices), candidates, seeds, int(board))


def planned_sequences(
    first: int, words: Sequence[RoomWords], tables: np.ndarray, num_texts: np.ndarray, count: int
) -> PlannedSequences:
    """Computes the sequences of consecutive rooms.

    Args:
        first: Number of the first room.
        words: Random words of each room.
        tables: Split by person and activity in each room, int (room, person, activity); -1: not generated.
        num_texts: Number of sentences of each activity.
        count: Sequences in each room.

    Returns:
        The sequences.

    Raises:
        InputError: If everything is held out twice, so that no sequence may be generated in a room.
    """
    if not (tables >= 0).any(axis=(1, 2)).all():
        raise InputError("the plan holds out every sequence of a room twice; hold out fewer people or activities")
    _, num_people, num_activities = tables.shape
    begin = np.array([one.choices % num_activities for one in words], np.uint64)
    keys = np.array([one.candidates for one in words], np.uint64)
    rooms = np.arange(len(words))[:, None]
    num_candidates = count + count // 2 + 2 * num_activities
    while True:
        counters = np.arange(num_candidates, dtype=np.uint64)[None]
        bits = counter_bits(keys[:, None], counters)
        person = bits % np.uint64(num_people)
        activity = (begin[:, None] + counters) % np.uint64(num_activities)
        split = tables[rooms, person, activity]
        kept = split >= 0
        rank = np.cumsum(kept, axis=1)
        if rank[:, -1].min() >= count:
            break
        num_candidates *= 2
    kept &= rank <= count
    shape = (len(words), count)
    text = (bits >> np.uint64(32)) % num_texts.astype(np.uint64)[activity]
    chosen = {"person": person, "activity": activity, "text": text, "split": split}
    columns = {name: values[kept].reshape(shape).astype(COLUMNS[name]) for name, values in chosen.items()}
    seeds = np.array([one.seeds for one in words], np.uint64)[:, None]
    return PlannedSequences(first=first, seed=counter_bits(seeds, np.arange(count, dtype=np.uint64)[None]), **columns)


def blocks_of_rooms(numbers: range, sequences_a_room: int) -> Iterator[range]:
    """Divides a range of rooms into blocks that fit into memory."""
    step = max(1, BLOCK_SEQUENCES // sequences_a_room)
    for first in range(numbers.start, numbers.stop, step):
        yield range(first, min(first + step, numbers.stop))


def held_out_leaks(
    blocks: Iterator[PlannedSequences], place_of: Callable[[int], tuple[str, int]], splits: Sequence[str]
) -> tuple[dict[str, int], list[str]]:
    """Counts the sequences of each split, and looks for held-out properties that occur in training.

    A leak is a kind of room, a layout, a person or an activity that a test holds out and training has, or one seed
    twice in a room, which would make two sequences of one performance. Equal seeds in two rooms are no leak: the same
    random numbers in another room give another signal.

    Args:
        blocks: Sequences of all rooms.
        place_of: Kind and layout of a room by number.
        splits: Names of the splits; "train" comes first.

    Returns:
        Sequences by split, and a line for each leak.
    """
    counts = np.zeros(len(splits), np.int64)
    held: dict[str, dict[str, set]] = {name: {} for name in splits}
    leaks: list[str] = []
    for block in blocks:
        counts += np.bincount(block.split.ravel(), minlength=len(splits))
        ordered = np.sort(block.seed, axis=1)
        if (ordered[:, 1:] == ordered[:, :-1]).any():
            leaks.append(
                f"a seed occurs twice in one of the rooms {block.first} to {block.first + len(block.seed) - 1}"
            )
        for number, name in enumerate(splits):
            is_own = block.split == number
            places = [place_of(block.first + int(room)) for room in np.flatnonzero(is_own.any(axis=1))]
            seen = {
                "kind": {kind for kind, _ in places},
                "layout": set(places),
                "person": set(np.unique(block.person[is_own]).tolist()),
                "activity": set(np.unique(block.activity[is_own]).tolist()),
            }
            for what, values in seen.items():
                held[name].setdefault(what, set()).update(values)
    keys = {"validation": "kind", "test_room": "kind", "test_layout": "layout"}
    keys |= {"test_person": "person", "test_activity": "activity"}
    for name, what in keys.items():
        for value in sorted(held[name].get(what, set()) & held["train"].get(what, set()), key=str):
            leaks.append(f"{what} {value} is held out for {name} and occurs in training")
    return dict(zip(splits, counts.tolist(), strict=True)), leaks
