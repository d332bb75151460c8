"""Where a .bin lacks packets that its recorder did not fill with zeros: every later frame begins too early in the file.

Static echoes and leakage make the first loop of every frame look alike. Where the loop at the expected place suddenly
does not, and one lying a whole number of packets earlier does, these packets are missing before it. The loop from which
on the frame is shifted is found the same way. Recordings whose loops do not resemble each other give no evidence.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.io.dca1000 import bytes_of_frame
from mmweaver.io.sample_files import PACKET_BYTES, Gap, JoinedFiles

MAX_PACKETS = 512  # lost in one place
ALIKE = 0.3  # normalised correlation of the first loops of successive frames; below, there is no evidence
UNLIKE = 0.9  # of its typical value: below, another place is looked for
CLEARLY = 0.15  # advantage of that place
SAME = 0.1  # loops are alike: of places with the same likeness, the one with the fewest packets is taken
MEMORY = 0.3  # weight of the latest frame in the mean that frames are compared with


def missing_packets(paths: tuple[Path, ...], config: RadarConfig) -> tuple[Gap, ...]:
    """Finds packets that are missing from a recording.

    Args:
        paths: The .bin, or its parts.
        config: The radar.

    Returns:
        Gaps in the order of the stream; empty if nothing is missing or the recording shows no evidence.
    """
    files, frame_bytes = JoinedFiles(paths), bytes_of_frame(config)
    loop_bytes = _loop_bytes(config)
    num_frames = files.size // frame_bytes
    if num_frames < 3 or files.size % frame_bytes == 0:  # nothing is missing from whole frames
        return ()
    heads = (_words(files, frame * frame_bytes, loop_bytes) for frame in range(num_frames))
    successive = np.array([_likeness(one, two) for one, two in pairwise(heads)])
    alike = successive[successive >= ALIKE]
    if len(alike) < 0.5 * len(successive):
        return ()
    return tuple(_gaps(files, config, float(np.median(alike))))


def _gaps(files: JoinedFiles, config: RadarConfig, typical: float) -> list[Gap]:
    frame_bytes, loop_bytes = bytes_of_frame(config), _loop_bytes(config)
    reference = _words(files, 0, loop_bytes).astype(np.float32)
    gaps: list[Gap] = []
    shift, frame = 0, 1  # bytes missing before the frame
    while (frame + 1) * frame_bytes - shift <= files.size:
        head = _words(files, frame * frame_bytes - shift, loop_bytes)
        if _likeness(reference, head) < UNLIKE * typical:
            packets = _packets_missing(files, frame * frame_bytes - shift, reference, frame_bytes)
            if packets:
                size = packets * PACKET_BYTES
                at = _place(files, config, frame - 1, shift, size)
                gaps.append(Gap(at=at, num_bytes=size, unsure=3 * loop_bytes))
                shift += size
                head = _words(files, frame * frame_bytes - shift, loop_bytes)
        if _likeness(reference, head) >= UNLIKE * typical:
            reference = reference + MEMORY * (head - reference)  # moving echoes average out
        frame += 1
    return gaps


def _packets_missing(files: JoinedFiles, expected: int, reference: np.ndarray, frame_bytes: int) -> int:
    """Number of packets by which a frame, and the one after it, begin earlier than expected; 0 if none fits better."""
    # one of the two may itself have lost its first loop
    likeness = np.maximum(*(_likeness_of_shifts(files, at, reference) for at in (expected, expected + frame_bytes)))
    likeness[0] += CLEARLY
    return int(np.flatnonzero(likeness > likeness.max() - SAME)[0])


def _likeness_of_shifts(files: JoinedFiles, expected: int, reference: np.ndarray) -> np.ndarray:
    """Likeness of the loop beginning 0, 1, ... packets before a byte; 0 where there is none or it is a whole loop."""
    found, size = np.zeros(MAX_PACKETS + 1), 2 * len(reference)
    first = max(0, expected - MAX_PACKETS * PACKET_BYTES)
    data = files.read(first, expected + size)
    for packets in range((expected - first) // PACKET_BYTES + 1):
        at = expected - first - packets * PACKET_BYTES
        if packets == 0 or packets * PACKET_BYTES % size:
            found[packets] = _likeness(reference, data[at : at + size].view("<i2"))
    return found


def _place(files: JoinedFiles, config: RadarConfig, frame: int, shift: int, size: int) -> int:
    """Byte of the stream from which on `size` bytes are missing, to a loop."""
    frame_bytes, loop_bytes = bytes_of_frame(config), _loop_bytes(config)
    start = frame * frame_bytes + 2 * config.frame_words_before
    reference = _words(files, start - shift, loop_bytes)
    gain = []
    for loop in range(1, config.num_loops):
        at = start + loop * loop_bytes - shift
        own, other = _words(files, at, loop_bytes), _words(files, at - size, loop_bytes)
        gain.append(_correlation(reference, own).real - _correlation(reference, other).real)
    # loops before the gap resemble the first at their own place, those after it at the shifted one
    score = np.concatenate([[0.0], np.cumsum(gain)])
    return start + int(np.flatnonzero(score > score.max() - CLEARLY)[0]) * loop_bytes


def _loop_bytes(config: RadarConfig) -> int:
    others = config.frame_words_before + config.frame_words_after
    return (bytes_of_frame(config) - 2 * others) // config.num_loops


def _words(files: JoinedFiles, first: int, num_bytes: int) -> np.ndarray:
    data = files.read(max(first, 0), max(first, 0) + num_bytes)
    return data[: len(data) // 2 * 2].view("<i2")


def _likeness(one: np.ndarray, other: np.ndarray) -> float:
    """Magnitude of the normalised correlation of words of the same number."""
    return abs(_correlation(one, other))


def _correlation(one: np.ndarray, other: np.ndarray) -> complex:
    """Normalised correlation of words of the same number, without their mean; 0 for words of another number."""
    if len(one) != len(other) or not len(one):
        return 0j
    a, b = (_complex(words - words.mean(dtype=np.float32)) for words in (one, other))
    return complex(np.vdot(a, b) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-30))


def _complex(words: np.ndarray) -> np.ndarray:
    """Words as complex numbers, so that an echo that moves between frames, which turns their phase, looks alike.

    Pairs of two lanes (I I Q Q or Q Q I I); in any other order a constant mixture, which is as good for comparison.
    """
    pairs = words[: len(words) // 4 * 4].reshape(-1, 2, 2)
    return pairs[:, 0] + 1j * pairs[:, 1]
