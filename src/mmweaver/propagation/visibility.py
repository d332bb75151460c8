"""Visibility of one motion in one room, stored as bits, so that its rays need not be cast again."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.tensor_record import TensorRecord


@dataclass(frozen=True, kw_only=True)
class Visibility(TensorRecord):
    """What rays decide about one person: visible skin, clear paths over the room's faces, occluded static paths."""

    skin: np.ndarray  # (frame, point) bool: faces the radar, and nothing lies between
    over_faces: np.ndarray  # (frame, face, ghost point) bool: the path over the face is clear, where it was tested
    occluded: np.ndarray  # (frame, static path) bool: the person is in the way

    def packed(self) -> np.ndarray:
        """Eight values per byte, uint8 (frame, byte)."""
        frames = len(self.skin)
        return np.packbits(np.concatenate([self.skin, self.over_faces.reshape(frames, -1), self.occluded], 1), axis=1)

    @classmethod
    def unpacked(cls, packed: np.ndarray, *, points: int, faces: int, ghosts: int, static_paths: int) -> "Visibility":
        """The inverse of `packed`.

        Args:
            packed: Bytes (frame, byte).
            points: Number of skin points.
            faces: Number of faces of the room.
            ghosts: Number of ghost points.
            static_paths: Number of static paths.
        """
        bits = np.unpackbits(packed, axis=1, count=points + faces * ghosts + static_paths).astype(bool)
        skin, over_faces, occluded = np.split(bits, [points, points + faces * ghosts], axis=1)
        return cls(skin=skin, over_faces=over_faces.reshape(len(packed), faces, ghosts), occluded=occluded)
