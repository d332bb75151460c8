"""A furnished room from its kind, layout and seed. Start with `make_room`, which lists the steps in order."""

from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import CameraIntrinsics, FreeSpace, Landmark, Plane, RgbdPhoto, Scene, Seat
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array, DepthPixels, Faces, PerFace, Rotation, Vec3, Vertices
from mmweaver.scene.layout.surfaces import MATERIAL_NAMES
from mmweaver.scene.photo.camera_file import d455_intrinsics
from mmweaver.scene.procedural.arrangement import (
    KINDS,
    FurnitureGroup,
    RoomKind,
    Shell,
    arrange,
    sample_group,
    sample_shell,
)
from mmweaver.scene.procedural.ground_truth import RadarFrame, free_space_of, landmarks_of, planes_of, seats_of
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.meshing import Mesh, make_room_mesh
from mmweaver.scene.procedural.palette import Palette, sample_palette
from mmweaver.scene.procedural.parts import Boxes, PlacedPiece, part_boxes
from mmweaver.scene.procedural.rendering import CameraView, cast_view, measured_depth, render_classes, render_rgb

MAX_LAYOUTS = 1000
_OF_SCENE = (  # fields shared with Scene
    "radar_from_camera",
    "vertices_m",
    "faces",
    "face_material",
    "material_names",
    "planes",
    "floor_z_m",
    "free_space",
    "seats",
    "landmarks",
)


@dataclass(frozen=True, kw_only=True)
class ProceduralRoom:
    """A room with complete ground truth, in the radar's frame (see core.records).

    `boxes` are those of all parts of the furniture, doors and windows, with the names of their pieces; `planes` the
    walls, floor, ceiling and the large faces of furniture. `photo` renders what a camera at the radar sees, `scene` is
    the true room; `reconstruction.reconstruct(room.photo())` is the room as reconstructed from the photo.
    """

    kind: str
    layout: int
    seed: int
    vertices_m: Vertices
    faces: Faces
    face_material: PerFace
    material_names: tuple[str, ...]
    boxes: Boxes
    planes: tuple[Plane, ...]
    floor_z_m: float
    seats: tuple[Seat, ...]
    landmarks: tuple[Landmark, ...]
    free_space: FreeSpace
    free_m2: float  # in the radar's window and the picture
    walkable_m2: float  # the largest connected part of it for the middle of a body
    intrinsics: CameraIntrinsics
    radar_from_camera: Rotation
    pieces: tuple[PlacedPiece, ...] = field(repr=False)  # in the room's own frame
    shell: Shell = field(repr=False)
    mesh: Mesh = field(repr=False)  # in the room's own frame

    def photo(self, lighting: str = "day", noise: bool = False) -> RgbdPhoto:
        """Renders colour, depth and classes in a D455's view, 640 x 480 pixels.

        Args:
            lighting: Name in LIGHTINGS.
            noise: Whether the depth has the errors and holes of a stereo camera.

        Raises:
            InputError: If the lighting is unknown.
        """
        photo_seed = int(stream(self.seed, "procedural", self.kind, self.layout, "photo").integers(2**31))
        return self._rendered(self._view, np.array(self.shell.radar_m), lighting, photo_seed, noise, self._colours)

    def further_photo(
        self, stand: RadarPose, lighting: str = "day", noise: bool = False, *, number: int = 1
    ) -> tuple[RgbdPhoto, Float[Array, "4 4"]]:
        """Renders the photo of a camera at another position.

        Args:
            stand: Position and yaw of the camera in the radar's frame.
            lighting: Name in LIGHTINGS.
            noise: Whether the depth has the errors and holes of a stereo camera.
            number: Number of the photo, which determines its noise.

        Returns:
            The photo, and the transform (4, 4) from its camera to that of `photo`, metres.

        Raises:
            InputError: If the lighting is unknown.
        """
        frame = RadarFrame(self.shell)
        right, ahead, up = stand.from_level
        own = np.stack([right, -up, ahead], axis=1)  # radar from this camera: x right, y down, z forward
        eye_m = frame.room_from_radar @ stand.position_m + frame.origin_m
        view = cast_view(self.mesh, self._caster, self.intrinsics, frame.room_from_radar @ own, eye_m)
        seed = int(stream(self.seed, "procedural", self.kind, self.layout, "photo", number).integers(2**31))
        pose = np.eye(4)
        pose[:3, :3] = self.radar_from_camera.T @ own
        pose[:3, 3] = self.radar_from_camera.T @ stand.position_m
        return self._rendered(view, eye_m, lighting, seed, noise, {}), pose

    def _rendered(
        self, view: CameraView, eye_m: Vec3, lighting: str, photo_seed: int, noise: bool, colours: dict[str, np.ndarray]
    ) -> RgbdPhoto:
        if lighting not in LIGHTINGS:
            raise InputError(f"unknown lighting {lighting!r}; known: {', '.join(LIGHTINGS)}")
        mesh, depth_m = self.mesh, view.depth_m
        if noise:
            is_glass = np.array([appearance.is_glass for appearance in mesh.appearances])[mesh.appearance[view.face]]
            offset = view.points_m - eye_m
            cos_view = np.abs((offset * view.normals).sum(axis=-1)) / np.linalg.norm(offset, axis=-1)
            depth_m = measured_depth(depth_m, self.intrinsics.fx, is_glass, cos_view, photo_seed)
        if lighting not in colours:
            colours[lighting] = render_rgb(mesh, self._caster, view, self.pieces, lighting, photo_seed)
        return RgbdPhoto(
            rgb=colours[lighting], depth_m=depth_m, intrinsics=self.intrinsics, classes=render_classes(mesh, view)
        )

    def scene(self, lighting: str = "day") -> Scene:
        """The true room, including what the camera cannot see.

        Args:
            lighting: Lighting of the photo, a name in LIGHTINGS.
        """
        return Scene(photo=self.photo(lighting), assumptions=(), **{name: getattr(self, name) for name in _OF_SCENE})

    @property
    def true_depth_m(self) -> DepthPixels:
        """True depth of every pixel along the optical axis, (480, 640) metres."""
        return self._view.depth_m

    @cached_property
    def _colours(self) -> dict[str, np.ndarray]:
        """Pictures (480, 640, 3) by lighting, rendered once: half a second each."""
        return {}

    @cached_property
    def _caster(self) -> RayCaster:
        return RayCaster(self.mesh.vertices_m, self.mesh.faces)

    @cached_property
    def _view(self) -> CameraView:
        room_from_camera = RadarFrame(self.shell).room_from_radar @ self.radar_from_camera
        return cast_view(self.mesh, self._caster, self.intrinsics, room_from_camera, np.array(self.shell.radar_m))


def make_room(kind: str, layout: int = 0, seed: int = 0) -> ProceduralRoom:
    """Makes the room of a kind, layout and seed; the same three give the same bits.

    Args:
        kind: Name in KINDS.
        layout: Arrangement of the furniture and position of the radar, 0 to 999.
        seed: Determines the room itself: size, door, windows, colours, furniture.

    Raises:
        InputError: If the kind is unknown, the layout out of range, or the seed negative.
    """
    return make_room_of(KINDS[kind], layout, seed)


def make_room_of(room_kind: RoomKind, layout: int, seed: int) -> ProceduralRoom:
    """Makes a room of a custom kind, such as one of KINDS with other sizes.

    Args:
        room_kind: What the room is sampled from.
        layout: As in `make_room`.
        seed: As in `make_room`.

    Raises:
        InputError: If the layout is out of range or the seed negative.
    """
    kind = room_kind.name
    if not 0 <= layout < MAX_LAYOUTS:
        raise InputError(f"the layout must be 0 to {MAX_LAYOUTS - 1}, not {layout}")
    if seed < 0:
        raise InputError(f"the seed must be 0 or above, not {seed}")
    draws = partial(stream, seed, "procedural", kind)
    palette = sample_palette(draws("palette"), room_kind.walls, room_kind.floors)
    shell = sample_shell(room_kind, palette, draws("shell"), draws(layout, "radar"))
    wanted = _sample_furniture(room_kind, palette, draws("furniture"))
    shell, placed, (free_m2, walkable_m2) = arrange(room_kind, shell, wanted, draws(layout, "arrangement"))
    pieces = (*shell.fixed, *placed)
    mesh, frame = make_room_mesh(shell.size_m, pieces, palette), RadarFrame(shell)
    boxes = frame.boxes(part_boxes(pieces))
    free = free_space_of(shell, boxes, frame)
    materials = np.array([MATERIAL_NAMES.index(appearance.material) for appearance in mesh.appearances])
    return ProceduralRoom(
        kind=kind,
        layout=layout,
        seed=seed,
        vertices_m=frame.points(mesh.vertices_m),
        faces=mesh.faces,
        face_material=materials[mesh.appearance],
        material_names=MATERIAL_NAMES,
        boxes=boxes,
        planes=planes_of(shell, pieces, palette, frame),
        floor_z_m=-shell.radar_m[2],
        seats=seats_of(pieces, frame),
        landmarks=landmarks_of(pieces, free, frame),
        free_space=free,
        free_m2=free_m2,
        walkable_m2=walkable_m2,
        intrinsics=d455_intrinsics(640, 480),
        radar_from_camera=_camera_rotation(shell, draws(layout, "camera")),
        pieces=pieces,
        shell=shell,
        mesh=mesh,
    )


def _sample_furniture(
    room_kind: RoomKind, palette: Palette, rng: np.random.Generator
) -> list[tuple[FurnitureGroup, bool]]:
    """The room's groups and whether each is required, in the order in which they are placed: required ones first."""
    wanted = [(sample_group(make, palette, rng), True) for make in room_kind.required]
    for share, make in room_kind.optional:
        group = sample_group(make, palette, rng)
        if rng.random() < share:
            wanted.append((group, False))
    return wanted


def _camera_rotation(shell: Shell, rng: np.random.Generator) -> Rotation:
    """The camera's rotation: along the radar's axis, pitched down the more the higher it stands, with a small roll."""
    pitch = np.deg2rad(2.0 + 12.0 * (shell.radar_m[2] - 0.5) + rng.uniform(-2, 5))
    roll = np.deg2rad(rng.uniform(-1.0, 1.0))
    level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    tilt = np.array([[1, 0, 0], [0, np.cos(pitch), np.sin(pitch)], [0, -np.sin(pitch), np.cos(pitch)]])
    lean = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1.0]])
    return level @ tilt @ lean
