"""Stored geometry from which signals are synthesised on the fly: prepared rooms and traced motions.

    OUT/office_003/geometry/       instead of iq and iq_scale
        node_joints_m    (sequence, frame, node, joint, axis) float32, at the nodes of propagation.frame_clock
        visibility       (sequence, frame, byte)  bits of propagation.visibility
        room/, photographed/   propagation.static_paths_store: the true room, and the room reconstructed from its photo

Reading it requires no ray caster. Reference: docs/decisions/data-set-plan.md.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_zarr import ZarrFolder, open_zarr
from mmweaver.datasets.checked_folder import CheckedFolder
from mmweaver.datasets.zarr_arrays import put_array
from mmweaver.propagation.body_model import DEFAULT_NUM_POINTS, ScatteringBody
from mmweaver.propagation.body_paths import GHOST_POINTS, ghost_points
from mmweaver.propagation.occlusion import Visibility
from mmweaver.propagation.paths import STATIC_KINDS, FrameClock, Interaction
from mmweaver.propagation.static_paths import AS_PUBLISHED, PreparedRoom, Propagation
from mmweaver.propagation.static_paths_store import room_arrays, room_of, room_words

if TYPE_CHECKING:
    from mmweaver.datasets.room_generation import RoomGeometry

GEOMETRY = "geometry"
ROOMS = ("room", "photographed")
FARTHEST_M = 1e4  # limit of joints and room coordinates; anything beyond indicates damage
# Arrays of a prepared room (`room_arrays`): shape and dtype kind.
ROOM_ARRAYS: dict[str, tuple[tuple[int | str, ...], str]] = {
    "count": ((len(STATIC_KINDS),), "iu"),
    "place_m": (("path", 3), "f"),
    "amplitude": (("path", 2), "f"),
    "mirrored_last_m": (("mirrored", 3), "f"),
    "mirrored_way_m": (("mirrored", "tx", "rx"), "f"),
    "face": (("face", 4, 3), "f"),
    "face_half_m": (("face", 2), "f"),
}


def write_geometry(group: Any, geometry: "RoomGeometry", traces: Sequence[tuple[np.ndarray, Visibility]]) -> None:
    """Writes geometry into a room's Zarr group.

    Args:
        group: The group.
        geometry: Static paths of the room.
        traces: Joints at the clock's nodes and visibility of each sequence, as in `GeneratedSequence`.
    """
    below = group.create_group(GEOMETRY)
    below.attrs.update({"skin": skin_mark(), "propagation": asdict(geometry.room.propagation)})
    if traces:
        axes = ("sequence", "frame", "node", "joint", "axis")
        _put(below, "node_joints_m", np.stack([joints_m for joints_m, _ in traces]), axes)
        bits = np.stack([visibility.packed() for _, visibility in traces])
        _put(below, "visibility", bits, ("sequence", "frame", "byte"))
    for name in ROOMS:
        room = getattr(geometry, name)
        inner = below.create_group(name)
        for key, values in room_arrays(room).items():
            _put(inner, key, values, (key, *(f"{key}_{axis}" for axis in range(1, values.ndim))))
        inner.attrs.update({"faces": room_words(room)})


def _put(group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...]) -> None:
    """Writes an array as one chunk; floats are bit-shuffled, since neighbouring values are similar."""
    from zarr.codecs import BloscCodec

    packing = BloscCodec(cname="zstd", clevel=7, shuffle="bitshuffle" if values.dtype.kind == "f" else "noshuffle")
    put_array(group, name, values, dimensions, packing=packing)


@lru_cache(maxsize=1)
def skin_mark() -> str:
    """Fingerprint of the skin points to which visibility refers; it changes with their number or positions."""
    body = ScatteringBody(0, REFERENCE_HEIGHT_M)
    parts = (body.part, np.round(1e6 * body.along).astype(np.int64), np.round(1e6 * body.angle_rad).astype(np.int64))
    return hashlib.sha256(np.concatenate([*parts, ghost_points(body)]).astype("<i8").tobytes()).hexdigest()[:16]


@dataclass(frozen=True, kw_only=True)
class StoredGeometry:
    """Geometry of one room, read at first use."""

    files: CheckedFolder  # folder of the room
    config: RadarConfig
    _resyntheses: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def node_joints_m(self) -> np.ndarray:
        """Joints at the clock's nodes in metres, (sequence, frame, node, 22, 3)."""
        shape = ("sequence", "frame", "node", 22, 3)
        with self.files.reading():
            return self._arrays.numbers("node_joints_m", shape, kinds="f", low=-FARTHEST_M, high=FARTHEST_M)

    @cached_property
    def _visibility(self) -> np.ndarray:
        bits = DEFAULT_NUM_POINTS + len(self.room.reflectors) * GHOST_POINTS + len(self.room.paths)
        with self.files.reading():
            return self._arrays.numbers("visibility", ("sequence", "frame", -(-bits // 8)), kinds="u", high=255)

    @cached_property
    def room(self) -> PreparedRoom:
        """The true room, in which signals are synthesised."""
        return self._read("room")

    @cached_property
    def photographed(self) -> PreparedRoom:
        """The room as reconstructed from its photo, which the network sees."""
        return self._read("photographed")

    def cube(self, motion: Any, frames: np.ndarray, *, realization: int, device: str) -> np.ndarray:
        """Synthesises frames of a traced motion.

        Args:
            motion: The `TracedMotion`.
            frames: Indices of frames.
            realization: Realization of speckle and noise.
            device: Torch device.

        Returns:
            Cube in sqrt(mW), complex64 (frame, range, doppler, antenna).
        """
        from mmweaver.signal.cube import cube_values

        samples = self.resynthesis(device).samples(motion, frames, realization=realization)
        return cube_values(samples, self.config).cpu().numpy()

    def resynthesis(self, device: str) -> Any:
        """Prepares the room for synthesis on a device, once per device.

        Args:
            device: Torch device.

        Returns:
            The room's `Resynthesis`.
        """
        from mmweaver.propagation.resynthesis import Resynthesis

        if device not in self._resyntheses:
            self._resyntheses[device] = Resynthesis(self.room, device)
        return self._resyntheses[device]

    def motion(self, index: int, *, person: int, height_m: float, seed: int) -> Any:
        """Reads the traced motion of one sequence.

        Args:
            index: Index of the sequence.
            person: Index of the person, which selects the body surface.
            height_m: Body height in metres.
            seed: Seed of the sequence.

        Returns:
            The `TracedMotion`.

        Raises:
            InputError: If the geometry is damaged or of another version.
        """
        from mmweaver.propagation.resynthesis import TracedMotion

        if index >= len(self._visibility):
            raise InputError(
                f"{self.files.folder} is damaged: it has the geometry of {len(self._visibility)} sequences, not of"
                f" sequence {index}; make it again"
            )
        sizes = {"points": DEFAULT_NUM_POINTS, "faces": len(self.room.reflectors), "ghosts": GHOST_POINTS}
        seen = Visibility.unpacked(self._visibility[index], **sizes, static_paths=len(self.room.paths))
        joints_m = self.node_joints_m[index]
        return TracedMotion(joints_m=joints_m, visibility=seen, subject=person, height_m=height_m, seed=seed)

    @cached_property
    def _arrays(self) -> ZarrFolder:
        self.files.check(f"{GEOMETRY}/")
        with self.files.reading():
            arrays = open_zarr(self.files.folder / GEOMETRY)
            if arrays.attrs.get("skin") != skin_mark():
                raise InputError(
                    f"{self.files.folder} was made by another version of mmweaver, whose people have another skin; make"
                    " the data set again"
                )
            num_nodes, stored = len(FrameClock(self.config).node_s), arrays.promise("node_joints_m").shape
            if len(stored) == 5 and stored[2] != num_nodes:
                raise InputError(
                    f"{self.files.folder} was made by another version of mmweaver, which kept joints at {stored[2]}"
                    f" instants a frame, not {num_nodes}; make the data set again"
                )
        return arrays

    def _read(self, name: str) -> PreparedRoom:
        with self.files.reading():
            group = self._arrays.group(name)
            arrays = {
                key: group.numbers(key, shape, kinds=kinds, low=-FARTHEST_M, high=FARTHEST_M)
                for key, (shape, kinds) in ROOM_ARRAYS.items()
            }
            words = group.attr("faces", list)
            group.check_shape("mirrored_way_m", (self.config.num_tx, self.config.num_rx), ("tx", "rx"))
            _check_room(group, arrays, words)
            return room_of(arrays, words, self.config, self._propagation)

    @property
    def _propagation(self) -> Propagation:
        """Propagation options of the stored rooms; older data sets do not state them."""
        known = {one.name: type(one.default) for one in fields(Propagation)}
        if "propagation" not in self._arrays.attrs:
            return AS_PUBLISHED
        kept = self._arrays.attr("propagation", dict)
        if {name: type(value) for name, value in kept.items()} != known:
            raise InputError(
                f"{self.files.folder} is damaged, or of another version of mmweaver: its propagation is {kept!r}; make"
                " it again"
            )
        return Propagation(**kept)


def _check_room(group: ZarrFolder, arrays: dict[str, np.ndarray], words: list[Any]) -> None:
    """Raises InputError if counts are inconsistent, lengths are not positive, or a face lacks kind or material."""
    group.check_shape("faces", (len(words),), ("face",))
    group.check_shape("count", (int(arrays["count"].sum()),), ("path",))
    mirrored = int(arrays["count"][STATIC_KINDS.index(Interaction.SPECULAR)])
    group.check_shape("count", (mirrored,), ("mirrored",))
    is_named = all(
        isinstance(pair, list) and len(pair) == 2 and {type(word) for word in pair} == {str} for pair in words
    )
    if not is_named or (arrays["count"] < 0).any() or (arrays["mirrored_way_m"] <= 0).any():
        raise InputError(f"{group.path} is damaged (its counts, lengths or faces); make it again")
