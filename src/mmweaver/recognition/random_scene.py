"""Random scenes for recordings: people, open rooms and radars, sampled for each one (domain randomisation)."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto, Scene

Span = tuple[float, float]
CHEST_M, TOWARDS = 1.1, (0.2, 1.1)  # height of a chest; tilt of a high radar relative to the angle down to it
HALF_M, TALL_M, CELL_M = 5.0, 2.4, 0.1  # half width and height of the room; cell size of its free floor
# of a closed room: distance of a wall from people, and of walls from the radar to either side, ahead and behind it
FROM_WALL_M, ASIDE_M, BACK_M, BEHIND_RADAR_M, CEILING_M = 0.4, (1.8, 4.0), (4.0, 7.5), (0.3, 1.5), (2.4, 3.0)
WALLS = ("metal", "concrete", "concrete", "brick")  # cupboards and boards return what a metal wall does
CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])[:, :, None]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """A flat upright object that roughly faces the radar."""

    centre_m: tuple[float, float, float]
    half_size_m: tuple[float, float]
    turn_rad: float  # about the vertical; 0 = square to the radar's axis
    material: str


@dataclass(frozen=True, kw_only=True)
class Variation:
    """Ranges from which each recording samples uniformly (`tempo` log-uniformly).

    `tempo` scales the speed of a motion, times `way_tempo` for locomotion (slower in a small room); `vigour` scales the
    excursion of joints from their mean position. For a path through the room `near_m` and `far_m` bound its distances,
    `way_s` is its duration in the motion's own time (a window is any part of it), `hurry` the variation of tempo (rms
    of its logarithm). `turn_deg` is the standard deviation of the heading of stationary people. `tilt_deg`
    rotates the reported points about the radar, up where positive. Values in `_db` change the noise figure, the CFAR
    threshold, the receiver gain, the albedo of skin, and the reflectivity of arms and legs relative to the trunk.
    In `high_share` of the recordings the radar is mounted `high_m` high and tilted down.
    """

    tempo: Span = (0.75, 1.6)
    way_tempo: float = 0.85
    near_m: Span = (0.6, 1.1)
    far_m: Span = (2.2, 3.1)
    way_s: Span = (5.0, 13.0)
    hurry: Span = (0.0, 0.4)
    vigour: Span = (0.6, 1.15)
    turn_deg: float = 25.0
    roam_mps: Span = (0.0, 0.06)
    distance_m: Span = (1.1, 2.6)
    azimuth_deg: Span = (-22.0, 22.0)
    height_m: Span = (1.5, 1.95)
    radar_height_m: Span = (1.0, 1.5)
    tilt_deg: Span = (-10.0, 10.0)
    high_share: float = 0.0
    high_m: Span = (1.6, 3.0)
    elevation_beamwidth_deg: Span = (20.0, 40.0)
    noise_db: Span = (10.0, 22.0)
    clutter_db: Span = (-15.0, 5.0)
    threshold_db: Span = (-4.0, 3.0)
    gain_db: Span = (-16.0, 0.0)
    albedo_db: Span = (-6.0, 4.0)
    skin_exponents: tuple[float, ...] = (40.0, 100.0, 200.0)
    arms_db: Span = (-8.0, 4.0)
    legs_db: Span = (-14.0, 0.0)
    skin_points: int = 4000
    wall_m: Span = (2.9, 5.4)
    wall_share: float = 0.3
    most_panels: int = 5


@dataclass(frozen=True, kw_only=True)
class VariationSample:
    """Sampled conditions of one recording, in the units of Variation."""

    tempo: float
    reach_m: Span
    way_s: float
    hurry: float
    vigour: float
    turn_deg: float
    roam_mps: float
    distance_m: float
    azimuth_deg: float
    height_m: float
    radar_height_m: float
    tilt_deg: float
    elevation_beamwidth_deg: float
    noise_db: float
    clutter_db: float
    threshold_db: float
    gain_db: float
    albedo_db: float
    skin_exponent: float
    arms_db: float
    legs_db: float
    wall_m: float | None
    panels: tuple[Panel, ...]

    @property
    def start_m(self) -> tuple[float, float]:
        """Start of the person, (x right, y away) in metres."""
        azimuth = np.radians(self.azimuth_deg)
        return float(self.distance_m * np.sin(azimuth)), float(self.distance_m * np.cos(azimuth))


def sample_variation(variation: Variation, rng: np.random.Generator) -> VariationSample:
    """Samples the conditions of one recording.

    Args:
        variation: Ranges of the conditions.
        rng: Random stream.
    """

    def uniform(*names: str) -> dict[str, float]:
        return {name: rng.uniform(*getattr(variation, name)) for name in names}

    found: dict[str, Any] = {"tempo": float(np.exp(rng.uniform(*np.log(variation.tempo))))}
    found |= uniform("vigour") | {"turn_deg": rng.normal(0, variation.turn_deg)}
    found |= uniform("roam_mps", "distance_m", "azimuth_deg", "height_m", "radar_height_m", "tilt_deg")
    found |= uniform("elevation_beamwidth_deg", "noise_db", "clutter_db", "threshold_db", "gain_db", "albedo_db")
    found |= {"skin_exponent": float(rng.choice(variation.skin_exponents))} | uniform("arms_db", "legs_db")
    found |= uniform("wall_m") if rng.random() < variation.wall_share else {"wall_m": None}
    found["panels"] = tuple(_panel(rng) for _ in range(int(rng.integers(variation.most_panels + 1))))
    found["reach_m"] = tuple(uniform("near_m", "far_m").values())
    return VariationSample(**found, **uniform("way_s", "hurry"))


def hung_high(now: VariationSample, variation: Variation, rng: np.random.Generator) -> VariationSample:
    """Conditions with the radar mounted high and tilted towards the person, with probability `high_share`.

    Args:
        now: Sampled conditions.
        variation: Ranges of the high mount.
        rng: Random stream.
    """
    is_high = rng.random() < variation.high_share
    height, towards = rng.uniform(*variation.high_m), rng.uniform(*TOWARDS)
    if not is_high:
        return now
    down_deg = float(np.degrees(np.arctan2(height - CHEST_M, now.distance_m)))
    return replace(now, radar_height_m=float(height), tilt_deg=float(towards) * down_deg + 0.5 * now.tilt_deg)


def _panel(rng: np.random.Generator) -> Panel:
    """A flat object to the side of the person, or behind."""
    aside = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.9, 2.5))
    return Panel(
        centre_m=(aside, rng.uniform(0.5, 5.0), rng.uniform(-0.8, 0.5)),
        half_size_m=(rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.6)),
        turn_rad=rng.normal(np.arctan2(-aside, 3.0), 0.4),
        material=str(rng.choice(["metal", "wood", "chipboard", "plasterboard"])),
    )


def random_scene(*, floor_z_m: float, wall_y_m: float | None, panels: tuple[Panel, ...] = ()) -> Scene:
    """A concrete floor, optionally a wall ahead, and panels; the whole floor is free.

    Panels reflect and occlude, but motion planning ignores them: place them where nobody walks.

    Args:
        floor_z_m: Height of the floor relative to the radar in metres, negative.
        wall_y_m: Distance of the wall, None for none.
        panels: Flat upright objects.
    """
    planes = [_floor(floor_z_m)]
    if wall_y_m is not None:
        middle = (0.0, wall_y_m, floor_z_m + TALL_M / 2)
        planes.append(_plane("wall", middle, (0, -1, 0), (1, 0, 0), "plasterboard", (HALF_M, TALL_M / 2)))
    return _scene(planes, panels, wall_y_m)


def closed_room(
    *, floor_z_m: float, people_m: Float[np.ndarray, "place 2"], panels: tuple[Panel, ...], rng: np.random.Generator
) -> Scene:
    """A room with four walls and a ceiling around people and radar, of sampled size and materials.

    Walls all around return multipath of people at 4 to 9 m and static clutter at all ranges, as recorded rooms do.

    Args:
        floor_z_m: Height of the floor relative to the radar in metres, negative.
        people_m: Places (place, 2), x right and y away, at which people are; none for an empty room.
        panels: Flat upright objects.
        rng: Random stream of the room.
    """
    aside_m = np.max(np.abs(people_m[:, 0]), initial=1.0) + FROM_WALL_M
    left, right = -max(rng.uniform(*ASIDE_M), aside_m), max(rng.uniform(*ASIDE_M), aside_m)
    far = max(rng.uniform(*BACK_M), np.max(people_m[:, 1], initial=3.0) + FROM_WALL_M)
    near, tall = -rng.uniform(*BEHIND_RADAR_M), rng.uniform(*CEILING_M)
    x, y, z = (left + right) / 2, (near + far) / 2, floor_z_m + tall / 2
    across, along, up = (right - left) / 2, (far - near) / 2, tall / 2
    walls = (
        ((x, far, z), (0, -1, 0), (1, 0, 0), across),
        ((left, y, z), (1, 0, 0), (0, 1, 0), along),
        ((right, y, z), (-1, 0, 0), (0, 1, 0), along),
        ((x, near, z), (0, 1, 0), (1, 0, 0), across),
    )
    planes = [_floor(floor_z_m)]
    planes += [_plane("wall", *wall, str(rng.choice(WALLS)), (half, up)) for *wall, half in walls]
    ceiling = (x, y, floor_z_m + tall)
    planes.append(_plane("ceiling", ceiling, (0, 0, -1), (1, 0, 0), "concrete", (across, along)))
    return _scene(planes, panels, far)


def _floor(floor_z_m: float) -> Plane:
    return _plane("floor", (0.0, HALF_M, floor_z_m), (0, 0, 1), (1, 0, 0), "concrete", (HALF_M, HALF_M))


def _scene(planes: list[Plane], panels: tuple[Panel, ...], free_y_m: float | None) -> Scene:
    flat = list(planes)
    for panel in panels:
        cos, sin = np.cos(panel.turn_rad), np.sin(panel.turn_rad)
        flat.append(_plane("panel", panel.centre_m, (sin, -cos, 0), (cos, sin, 0), panel.material, panel.half_size_m))
    vertices_m = [
        plane.centre_m
        + CORNERS[:, 0] * plane.half_size_m[0] * plane.axis_u
        + CORNERS[:, 1] * plane.half_size_m[1] * plane.axis_v
        for plane in flat
    ]
    faces = 4 * np.arange(len(flat))[:, None, None] + np.array([(0, 1, 2), (0, 2, 3)])
    x_m, y_m = np.arange(-HALF_M, HALF_M, CELL_M), np.arange(0.0, 2 * HALF_M, CELL_M)
    free = np.ones((len(y_m), len(x_m)), bool)
    if free_y_m is not None:
        free &= y_m[:, None] < free_y_m
    return Scene(
        photo=RgbdPhoto(  # with everything ahead in view, since motion planning tests what is in the picture
            rgb=np.zeros((2, 2, 3), np.uint8),
            depth_m=np.full((2, 2), np.nan),
            intrinsics=CameraIntrinsics(fx=0.05, fy=0.05, cx=1.0, cy=1.0, width=2, height=2),
        ),
        radar_from_camera=np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
        vertices_m=np.concatenate(vertices_m).astype(np.float32),
        faces=faces.reshape(-1, 3).astype(np.int32),
        face_material=np.repeat(np.arange(len(flat)), 2).astype(np.int32),
        material_names=tuple(plane.material for plane in flat),
        planes=tuple(planes),
        floor_z_m=float(planes[0].centre_m[2]),
        free_space=FreeSpace(x_m=x_m, y_m=y_m, is_free=free, is_seen=free),
        seats=(),
        assumptions=("the room is sampled at random",),
    )


def _plane(kind: str, centre: Any, normal: Any, u: Any, material: str, half: tuple[float, float]) -> Plane:
    n, axis = np.asarray(normal, float), np.asarray(u, float)
    return Plane(
        kind=kind,
        centre_m=np.asarray(centre, float),
        normal=n,
        axis_u=axis,
        axis_v=np.cross(n, axis),
        half_size_m=half,
        material=material,
    )
