"""The order in which cells (time, range, doppler) are coded: a coarse lattice first, then the cells in between.

Every cell but those of the first phase has known neighbours on both sides along at least one axis, whatever the shape.
"""

from functools import cache
from itertools import product

Phase = tuple[int, int, int]

# parity of (time, range, doppler)
PHASES: tuple[Phase, ...] = (
    (0, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0), (1, 1, 1)
)  # fmt: skip
WEIGHTS = {1: 4, 2: 2, 3: 1}  # of a neighbour, by the number of axes along which it differs


@cache
def known_neighbours(phase: Phase) -> tuple[tuple[Phase, int], ...]:
    """Offsets and weights of the neighbours that belong to earlier phases."""
    rank = PHASES.index(phase)
    found: list[tuple[Phase, int]] = []
    steps = (-1, 0, 1)
    for time, row, column in product(steps, steps, steps):
        parity = (phase[0] ^ abs(time), phase[1] ^ abs(row), phase[2] ^ abs(column))
        if PHASES.index(parity) < rank:
            found.append(((time, row, column), WEIGHTS[abs(time) + abs(row) + abs(column)]))
    return tuple(found)
