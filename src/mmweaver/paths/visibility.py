"""What rays found out about one motion in one room, kept as bits: no ray need be cast for it again."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Visibility:
    """Of one person's skin points, of their ways over the room's faces, and of the room's echoes behind the person."""

    skin: np.ndarray  # (frame, point) bool: faces the radar, and nothing lies between
    over_faces: np.ndarray  # (frame, face, ghost point) bool: the way over the face is free, where it was asked
    hidden: np.ndarray  # (frame, resting echo) bool: the person stands before it

    def frames(self, chosen: np.ndarray) -> "Visibility":
        """That of some frames."""
        return Visibility(skin=self.skin[chosen], over_faces=self.over_faces[chosen], hidden=self.hidden[chosen])

    def packed(self) -> np.ndarray:
        """Eight bits a byte, uint8 (frame, byte)."""
        frames = len(self.skin)
        return np.packbits(np.concatenate([self.skin, self.over_faces.reshape(frames, -1), self.hidden], 1), axis=1)

    @classmethod
    def unpacked(cls, packed: np.ndarray, *, points: int, faces: int, ghosts: int, echoes: int) -> "Visibility":
        """The inverse of `packed`, for so many skin points, faces, ghost points and resting echoes."""
        bits = np.unpackbits(packed, axis=1, count=points + faces * ghosts + echoes).astype(bool)
        skin, over_faces, hidden = np.split(bits, [points, points + faces * ghosts], axis=1)
        return cls(skin=skin, over_faces=over_faces.reshape(len(packed), faces, ghosts), hidden=hidden)
