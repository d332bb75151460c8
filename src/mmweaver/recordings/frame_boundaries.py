"""Detection of a wrong number of loops per frame, from moving echoes.

Loops follow each other within about a millisecond, frames within tens of milliseconds. A moving echo rotates by the
same phase from loop to loop within a frame, but by an arbitrary phase across the pause between frames. If every second
step between frames looks like those within, two frames are actually one; if steps within a frame vary as much as those
between frames, a frame is actually several. Static echoes and frames without a pause carry no evidence.
"""

from collections.abc import Iterator

import numpy as np

from mmweaver.core.records import AdcCube

FRAMES = 48  # maximum number of frames examined
PARTS = (2, 3, 4)
JUMP = 4.0  # minimum ratio of the change across a pause to that within a frame
MIN_CHANGE = 0.05  # relative to the power of moving echoes: changes within a frame are smaller
MIN_STEPS = 4  # steps of each kind


def loops_of_other_frames(adc: AdcCube) -> Iterator[str]:
    """Checks the number of loops per frame.

    Args:
        adc: Raw samples.

    Yields:
        A sentence if the recording probably has more or fewer loops per frame than its radar.
    """
    loops = adc.config.num_loops
    if loops < 2:
        return
    chirps = adc.samples[:FRAMES, :, 0]  # one transmitter
    within, between = _changes(chirps.reshape(len(chirps), loops, -1))
    for parts in PARTS:
        if (
            loops % parts == 0
            and loops > 2 * parts
            and len(between) >= MIN_STEPS
            and _is_several(within, between, parts)
        ):
            yield _advice(loops, loops // parts, "echoes that move jump within each frame")
            return
    for parts in PARTS:
        if len(between) >= MIN_STEPS * parts and _is_part(within, between, parts):
            yield _advice(loops, loops * parts, "echoes that move go on from one frame to the next without a pause")
            return


def _changes(stream: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Deviation of each step (frame, loop) from the typical one of its frame, and of each step to the next frame."""
    num_frames, loops = stream.shape[:2]
    flat = stream.reshape(num_frames * loops, -1)
    flat = flat - flat.mean(axis=0)
    power = max(float((np.abs(flat) ** 2).sum(axis=1).mean()), 1e-300)
    step = np.append((flat[:-1].conj() * flat[1:]).sum(axis=1) / power, 0).reshape(num_frames, loops)
    inside, own = step[:, :-1], np.median(step[:, :-1].real, axis=1) + 1j * np.median(step[:, :-1].imag, axis=1)
    return np.abs(inside - own[:, None]) ** 2, np.abs(step[:-1, -1] - own[:-1]) ** 2


def _is_several(within: np.ndarray, between: np.ndarray, parts: int) -> bool:
    loops = within.shape[1] + 1
    seams = [number * loops // parts - 1 for number in range(1, parts)]
    typical = np.median(within, axis=0)
    rest = max(np.median(np.delete(typical, seams)), MIN_CHANGE)
    return bool(typical[seams].min() > max(JUMP * rest, np.median(between) / JUMP))


def _is_part(within: np.ndarray, between: np.ndarray, parts: int) -> bool:
    is_last = np.arange(len(between)) % parts == parts - 1
    small = np.median(between[~is_last])
    is_small = small < JUMP / 2 * max(np.median(within), MIN_CHANGE)
    return bool(is_small and np.median(between[is_last]) > JUMP * max(small, MIN_CHANGE))


def _advice(own: int, likely: int, why: str) -> str:
    return f"{why}: the frames of the recording probably have {likely} loops, not {own}; --radar is probably another"
