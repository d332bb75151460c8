"""A furnished room made from its kind, layout and seed. Read this file first: `make_room` names the steps in order."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import CameraIntrinsics, FreeSpace, Landmark, Plane, RgbdPhoto, Scene, Seat
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import DepthPixels, Faces, PerFace, Rotation, Vertices
from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.scene.layout.surface_materials import MATERIAL_NAMES
from mmweaver.scene.photo.camera_file import d455_intrinsics
from mmweaver.scene.procedural.arrangement import Shell, arrange, draw_shell
from mmweaver.scene.procedural.depth_noise import measured_depth
from mmweaver.scene.procedural.ground_truth import (
    RadarFrame,
    face_materials,
    free_space_of,
    landmarks_of,
    planes_of,
    seats_of,
)  # fmt: skip
from mmweaver.scene.procedural.groups import drawn
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.meshing import Mesh, mesh_of
from mmweaver.scene.procedural.palette import Palette, draw_palette
from mmweaver.scene.procedural.parts import Boxes, Placed, boxes_of
from mmweaver.scene.procedural.rendering import CameraView, class_mask, developed, look_at
from mmweaver.scene.procedural.room_kinds import KINDS, Kind

MAX_LAYOUTS = 1000


@dataclass(frozen=True, kw_only=True)
class ProceduralRoom:
    """A room whose every truth is known. Everything is in the radar's frame (see core.records).

    `boxes` are those of all parts of the furniture, doors and windows, with the names of their pieces; `planes` the
    walls, floor, ceiling and the large faces of furniture. `photo` is what a camera at the radar sees, `scene` the
    room as it truly is; `reconstruction.reconstruct(room.photo())` is the room as the product sees it.
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
    walkable_m2: float  # the largest connected part of it that a body's middle may use
    intrinsics: CameraIntrinsics
    radar_from_camera: Rotation
    pieces: tuple[Placed, ...] = field(repr=False)  # in the room's own frame
    shell: Shell = field(repr=False)
    mesh: Mesh = field(repr=False)  # in the room's own frame, with looks

    def photo(self, lighting: str = "day", noise: bool = False) -> RgbdPhoto:
        """Colour, depth and classes (640 x 480, a D455's view). With `noise` the depth errs and has holes.

        Raises InputError for a lighting that is not in LIGHTINGS.
        """
        if lighting not in LIGHTINGS:
            raise InputError(f"unknown lighting {lighting!r}; known: {', '.join(LIGHTINGS)}")
        view, mesh = self._view, self.mesh
        own = int(stream(self.seed, "procedural", self.kind, self.layout, "photo").integers(2**31))
        depth_m = view.depth_m
        if noise:
            is_glass = np.array([look.is_glass for look in mesh.looks])[mesh.look[view.face]]
            away = view.points_m - np.array(self.shell.radar_m)
            cos_view = np.abs((away * view.normals).sum(axis=-1)) / np.linalg.norm(away, axis=-1)
            depth_m = measured_depth(depth_m, self.intrinsics.fx, is_glass, cos_view, own)
        return RgbdPhoto(
            rgb=developed(mesh, self._caster, view, self.pieces, lighting, own),
            depth_m=depth_m,
            intrinsics=self.intrinsics,
            classes=class_mask(mesh, view),
        )

    def scene(self, lighting: str = "day") -> Scene:
        """The true room: what the radar really sees, behind what the camera sees too."""
        return Scene(
            photo=self.photo(lighting),
            radar_from_camera=self.radar_from_camera,
            vertices_m=self.vertices_m,
            faces=self.faces,
            face_material=self.face_material,
            material_names=self.material_names,
            planes=self.planes,
            floor_z_m=self.floor_z_m,
            free_space=self.free_space,
            seats=self.seats,
            assumptions=(),
            landmarks=self.landmarks,
        )

    @property
    def true_depth_m(self) -> DepthPixels:
        """Of every pixel along the optical axis, without the camera's errors."""
        return self._view.depth_m

    @cached_property
    def _caster(self) -> RayCaster:
        return RayCaster(self.mesh.vertices_m, self.mesh.faces)

    @cached_property
    def _view(self) -> CameraView:
        turn = RadarFrame(self.shell).room_from_radar @ self.radar_from_camera
        return look_at(self.mesh, self._caster, self.intrinsics, turn, np.array(self.shell.radar_m))


def make_room(kind: str, layout: int = 0, seed: int = 0) -> ProceduralRoom:
    """The room of that kind, arranged in that way; the same three give the same bits.

    The seed draws the room (size, door, windows, colours, furniture), the layout how it is arranged and where in it
    the radar stands. Raises InputError for an unknown kind, a layout outside 0 to 999, or a negative seed.
    """
    recipe = KINDS[kind]
    if not 0 <= layout < MAX_LAYOUTS:
        raise InputError(f"the layout must be 0 to {MAX_LAYOUTS - 1}, not {layout}")
    if seed < 0:
        raise InputError(f"the seed must be 0 or above, not {seed}")
    palette = draw_palette(stream(seed, "procedural", kind, "palette"), recipe.walls, recipe.floors)
    shell = draw_shell(
        recipe, palette, stream(seed, "procedural", kind, "shell"), stream(seed, "procedural", kind, layout, "radar")
    )
    wanted = _furniture(recipe, palette, seed)
    shell, placed, floor = arrange(recipe, shell, wanted, stream(seed, "procedural", kind, layout, "arrangement"))
    pieces = (*shell.fixed, *placed)
    mesh, frame = mesh_of(shell.size_m, pieces, palette), RadarFrame(shell)
    boxes = frame.boxes(boxes_of(pieces))
    free = free_space_of(shell, boxes, frame)
    return ProceduralRoom(
        kind=kind, layout=layout, seed=seed,
        vertices_m=frame.points(mesh.vertices_m), faces=mesh.faces, face_material=face_materials(mesh),
        material_names=MATERIAL_NAMES, boxes=boxes, planes=planes_of(shell, pieces, palette, frame),
        floor_z_m=-shell.radar_m[2], seats=seats_of(pieces, frame), landmarks=landmarks_of(pieces, free, frame),
        free_space=free, free_m2=floor.free_m2, walkable_m2=floor.walkable_m2,
        intrinsics=d455_intrinsics(640, 480),
        radar_from_camera=_camera(shell, stream(seed, "procedural", kind, layout, "camera")),
        pieces=pieces, shell=shell, mesh=mesh,
    )  # fmt: skip


def _furniture(recipe: Kind, palette: Palette, seed: int) -> list:
    """The room's groups, in the order in which they are placed: those that must stand first."""
    rng = stream(seed, "procedural", recipe.name, "furniture")
    wanted = [(drawn(make, palette, rng), True) for make in recipe.always]
    for share, make in recipe.sometimes:
        group = drawn(make, palette, rng)
        if rng.random() < share:
            wanted.append((group, False))
    return wanted


def _camera(shell: Shell, rng: np.random.Generator) -> Rotation:
    """Looks where the radar looks, down by more the higher it stands, leaning a little as tripods do."""
    pitch = np.deg2rad(2.0 + 12.0 * (shell.radar_m[2] - 0.5) + rng.uniform(-2, 5))
    roll = np.deg2rad(rng.uniform(-1.0, 1.0))
    level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    tilt = np.array([[1, 0, 0], [0, np.cos(pitch), np.sin(pitch)], [0, -np.sin(pitch), np.cos(pitch)]])
    lean = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1.0]])
    return level @ tilt @ lean
