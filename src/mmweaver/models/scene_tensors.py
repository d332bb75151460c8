"""A room as input of the networks: a small picture, the static paths of what it shows, and the flat faces.

Inputs of the network and of second-order paths: a photographed room, traced once for one radar.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.pinhole import resized
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import ClassMask, Plane, Scene
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.propagation.antenna import scatterer_gain
from mmweaver.propagation.diffuse_clutter import diffuse_clutter, seed_of_room
from mmweaver.propagation.image_method import SpecularReflector, apparent_direction
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.radar_equation import direction_loss_db
from mmweaver.propagation.static_paths import ALL_PATHS, FIRST_ORDER, PreparedRoom, Propagation, RayTracedRoom
from mmweaver.propagation.things import ThingPaths, reflector_paths
from mmweaver.scene.photo.depth_grid import DepthGrid, make_grid

IMAGE_ROWS, IMAGE_COLUMNS = 120, 160
IMAGE_CHANNELS = 5  # red, green, blue, depth, class (paper: RGB + depth + mask)
NUM_POINTS, POINT_FEATURES = 5000, 11
NUM_PLANES, PLANE_FEATURES = 8, 13
FARTHEST_M = 8.0
NUM_CLASSES = 182.0  # of COCO-Stuff
REFLECTION_COS = np.linspace(0.0, 1.0, 17)  # cosines of the angle of incidence
PLANE_KINDS = ("floor", "ceiling", "wall", "top", "panel")


@dataclass(frozen=True, kw_only=True)
class SceneTensors(TensorRecord):
    """Tensors of one room, or of several with a leading axis, in the radar's coordinates."""

    image: Tensor  # (channel, row, column), 0 where unknown
    depth_m: Tensor  # (row, column) along the optical axis; 0 = no measurement
    point_m: Tensor  # (point, 3)
    point_cross_section_m2: Tensor  # (point,) predicted by physics for the photographed room; 0 = no point
    point_features: Tensor  # (point, POINT_FEATURES)
    camera_from_radar: Tensor  # (3, 3)
    camera_m: Tensor  # (3,) position of the camera
    camera: Tensor  # (4,) fx, fy, cx, cy in cells of the picture
    plane_centre_m: Tensor  # (plane, 3)
    plane_axes: Tensor  # (plane, 3, 3): u, v, normal
    plane_half_m: Tensor  # (plane, 2); 0 = no plane
    plane_features: Tensor  # (plane, PLANE_FEATURES)
    plane_reflection: Tensor  # (plane, angle) reflected power share of a face at REFLECTION_COS

    @classmethod
    def of(cls, scene: Scene, config: RadarConfig, room: PreparedRoom | None = None) -> "SceneTensors":
        """Tensors of a scene's photo, with the scene's faces and the static paths of the radar.

        Args:
            scene: The scene.
            config: The radar.
            room: The scene prepared for this radar; by default it is traced here.
        """
        grid = make_grid(scene.photo)
        rows = _nearest(IMAGE_ROWS, grid.depth_m.shape[0])
        columns = _nearest(IMAGE_COLUMNS, grid.depth_m.shape[1])
        camera = resized(grid.intrinsics, IMAGE_COLUMNS, IMAGE_ROWS)
        view = np.ix_(rows, columns)
        room = room or RayTracedRoom(scene, config, propagation=FIRST_ORDER)
        return cls(
            image=_tensor(_image(grid, scene, view)),
            depth_m=_tensor(np.nan_to_num(grid.depth_m[view])),
            **_points(room, scene),
            camera_from_radar=_tensor(scene.radar_from_camera.T),
            camera_m=_tensor(scene.radar_pose.seen(np.zeros(3))),
            camera=_tensor(np.array([camera.fx, camera.fy, camera.cx, camera.cy])),
            **_planes(scene, room),
        )


def _nearest(wanted: int, given: int) -> np.ndarray:
    return np.minimum(((np.arange(wanted) + 0.5) * given / wanted).astype(int), given - 1)


def _image(grid: DepthGrid, scene: Scene, view: tuple[np.ndarray, ...]) -> np.ndarray:
    depth = np.nan_to_num(grid.depth_m[view]) / FARTHEST_M
    colour = grid.rgb[view].transpose(2, 0, 1)
    return np.concatenate([colour, depth[None], _mask(scene.photo.classes, view, grid)[None]])


def _mask(classes: ClassMask | None, view: tuple[np.ndarray, ...], grid: DepthGrid) -> np.ndarray:
    """Class of the middle pixel of every cell, scaled to 0 to 1."""
    if classes is None:
        return np.zeros((IMAGE_ROWS, IMAGE_COLUMNS))
    rows, columns = classes.index.shape
    row = ((view[0] + 0.5) * rows / grid.depth_m.shape[0]).astype(int)
    column = ((view[1] + 0.5) * columns / grid.depth_m.shape[1]).astype(int)
    return classes.index[row, column] / NUM_CLASSES


def _points(room: PreparedRoom, scene: Scene) -> dict[str, Tensor]:
    """The strongest static paths of the photographed room, each as a scatterer at its apparent position."""
    config, first = room.config, room.first_order
    level = first.amplitude.abs().numpy()
    order = np.argsort(-level)[:NUM_POINTS]
    paths = first[torch.from_numpy(order)]
    distance = np.maximum(paths.length_m.mean(dim=(1, 2)).numpy() / 2, 0.1)
    towards = apparent_direction(paths.departure_vertex_m, paths.arrival_vertex_m).numpy()
    loss_db = direction_loss_db(_tensor(towards[:, [0, 2]]), config).numpy()
    gain = scatterer_gain(config) * 10 ** (-loss_db / 10)  # as `radar_view.points_of` will apply it
    cross_section = (level[order] * distance**2 / gain) ** 2
    place = towards * distance[:, None]
    kind = np.searchsorted(np.cumsum(list(room.counts.values())), order, side="right")
    features = np.column_stack(
        [
            distance / 4,
            place / 4,
            (place[:, 2] - scene.floor_z_m) / 2,
            towards[:, 0],
            towards[:, 2],
            np.log10(np.maximum(cross_section, 1e-12)) / 4,
            *(kind == index for index in range(len(room.counts))),
        ]
    )
    count = len(order)
    return {
        "point_m": _tensor(_padded(place, count)),
        "point_cross_section_m2": _tensor(_padded(cross_section, count)),
        "point_features": _tensor(_padded(features, count)),
    }


def _padded(values: np.ndarray, count: int) -> np.ndarray:
    """Padded with rows of zeros to NUM_POINTS; such a point is at the radar and returns nothing."""
    return np.concatenate([values, np.zeros((NUM_POINTS - count, *values.shape[1:]))])


def _planes(scene: Scene, room: PreparedRoom) -> dict[str, Tensor]:
    """The floor and the largest faces, the largest first; rows of zeros where there are fewer."""
    faces = sorted(scene.planes, key=lambda plane: (plane.kind != "floor", -math.prod(plane.half_size_m)))[:NUM_PLANES]
    centre, axes = np.zeros((NUM_PLANES, 3)), np.tile(np.eye(3), (NUM_PLANES, 1, 1))
    half, features = np.zeros((NUM_PLANES, 2)), np.zeros((NUM_PLANES, PLANE_FEATURES))
    reflection = np.zeros((NUM_PLANES, len(REFLECTION_COS)))
    for index, plane in enumerate(faces):
        centre[index], half[index] = plane.centre_m, plane.half_size_m
        axes[index] = np.stack([plane.axis_u, plane.axis_v, plane.normal])
        features[index] = _plane_features(plane)
        reflector = SpecularReflector(
            plane=plane, offset_m=float(plane.normal @ plane.centre_m), is_rough=room.propagation.fine_roughness
        )
        each = [reflector.coefficient(REFLECTION_COS, one) for one in room.frequencies_hz]
        reflection[index] = np.mean(np.abs(each) ** 2, axis=0)
    return {
        "plane_centre_m": _tensor(centre),
        "plane_axes": _tensor(axes),
        "plane_half_m": _tensor(half),
        "plane_features": _tensor(features),
        "plane_reflection": _tensor(reflection),
    }


def _plane_features(plane: Plane) -> np.ndarray:
    """Kind, distance, direction, and position of the foot of the radar's perpendicular within the face."""
    distance = float(plane.normal @ -plane.centre_m)
    foot = -distance * plane.normal - plane.centre_m
    inside = [
        plane.half_size_m[0] - abs(float(foot @ plane.axis_u)),
        plane.half_size_m[1] - abs(float(foot @ plane.axis_v)),
    ]
    kind = [float(plane.kind == name) for name in PLANE_KINDS]
    return np.array([*kind, distance / 4, *plane.normal, *np.tanh(inside), *(np.array(plane.half_size_m) / 3)])


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values, dtype=np.float32))


@dataclass(frozen=True, kw_only=True)
class GivenRoom:
    """The network corrects the first-order paths in `view`; all other paths are those of physics."""

    view: SceneTensors
    traced: RayTracedRoom
    others: StaticPaths  # of second order, clutter, and reflectors
    things: ThingPaths
    scene: Scene

    @classmethod
    def of(
        cls, scene: Scene, config: RadarConfig, *, seed: int = 0, propagation: Propagation = ALL_PATHS
    ) -> "GivenRoom":
        """Traces a scene.

        Args:
            scene: The room.
            config: The radar.
            seed: Seed of phases and clutter.
            propagation: Which paths are traced.
        """
        traced = RayTracedRoom(scene, config, seed, propagation)
        others = [traced.paths.select(Interaction.ROOM_ROOM)]
        if propagation.clutter:
            others.append(diffuse_clutter(config, seed_of_room(scene) + seed, scene))
        if scene.reflectors:
            others.append(reflector_paths(scene.reflectors, scene.radar_pose, config))
        things = ThingPaths(scene, config)
        return cls(
            scene=scene,
            things=things,
            view=SceneTensors.of(scene, config, traced),
            traced=traced,
            others=StaticPaths.cat(others),
        )
