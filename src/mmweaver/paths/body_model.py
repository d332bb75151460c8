"""A person as the radar sees one: capsules around the bones, points on their skin that ride along.

The points and their micro-phases belong to the subject, not to the sequence: the same person in another motion has
the same skin. Reference: physics of published 77 GHz body models, docs/radar_primer.md, section 4.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.paths.skin_scattering import SkinEcho

REFERENCE_HEIGHT_M = 1.75
AVERAGE_SUBJECT, AVERAGE_NUM_POINTS = 90_000, 600  # the average body, no subject of a generated sequence
DEFAULT_NUM_POINTS = 800
RING = 6  # corners of a capsule's low-poly hull


@dataclass(frozen=True, kw_only=True)
class Capsule:
    """A part of the body: from joint to joint (or past it), with a radius at either end for a 1.75 m person."""

    start: str
    end: str
    start_radius_m: float
    end_radius_m: float
    rest: tuple[float, float, float]  # where it usually points in the torso's frame (right, front, up)
    extend_m: float = 0.0  # past the end joint: hands, the crown of the head


def _both_sides(start: str, end: str, radii: tuple[float, float], rest: tuple[float, float, float], extend_m=0.0):
    """The left and the right one of a pair; `rest` is the right one's."""
    return [
        Capsule(
            start=f"{side}_{start}" if start in PAIRED else start,
            end=f"{side}_{end}",
            start_radius_m=radii[0],
            end_radius_m=radii[1],
            rest=(sign * rest[0], rest[1], rest[2]),
            extend_m=extend_m,
        )
        for side, sign in (("left", -1.0), ("right", 1.0))
    ]


PAIRED = {"hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist"}
DOWN, UP, FRONT = (0.0, 0.0, -1.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
ARM = (0.45, 0.45, -0.77)  # the opposite, behind and above the other shoulder, is out of reach

CAPSULES: tuple[Capsule, ...] = (
    Capsule(start="pelvis", end="spine1", start_radius_m=0.125, end_radius_m=0.115, rest=UP),
    Capsule(start="spine1", end="spine2", start_radius_m=0.115, end_radius_m=0.115, rest=UP),
    Capsule(start="spine2", end="spine3", start_radius_m=0.115, end_radius_m=0.125, rest=UP),
    Capsule(start="spine3", end="neck", start_radius_m=0.12, end_radius_m=0.06, rest=UP),
    Capsule(start="neck", end="head", start_radius_m=0.055, end_radius_m=0.075, rest=UP),
    Capsule(start="head", end="head", start_radius_m=0.085, end_radius_m=0.095, rest=UP, extend_m=0.10),
    *_both_sides("hip", "hip", (0.105, 0.105), DOWN, 0.02),
    *_both_sides("collar", "shoulder", (0.07, 0.06), (1.0, 0.0, 0.0)),
    *_both_sides("hip", "knee", (0.085, 0.058), DOWN),
    *_both_sides("knee", "ankle", (0.055, 0.038), DOWN),
    *_both_sides("ankle", "foot", (0.038, 0.035), FRONT, 0.05),
    *_both_sides("shoulder", "elbow", (0.05, 0.042), ARM),
    *_both_sides("elbow", "wrist", (0.042, 0.03), ARM),
    *_both_sides("wrist", "wrist", (0.042, 0.04), ARM, 0.12),
)
TORSO_WIDTH_FRONT = 1.25  # the trunk is wider than deep: its cross-section is an ellipse
TORSO = {"pelvis", "spine1", "spine2", "spine3"}
CHEST = {"pelvis": 0.3, "spine1": 0.7, "spine2": 1.0, "spine3": 0.8}  # how far each part of the trunk breathes
CHEST_BACK = 0.15  # and its back, of its front
# A part that ends at its own start continues the bone before it: the hand the forearm, the crown the neck.
CONTINUES = {"head": "neck", "left_wrist": "left_elbow", "right_wrist": "right_elbow"}


@dataclass(frozen=True, kw_only=True)
class Skin:
    """Points of a body at some times: place and outward normal (time, point, 3)."""

    place_m: np.ndarray
    normal: np.ndarray


class ScatteringBody:
    """One subject's capsules and skin points; `skin` and `hull` pose them."""

    def __init__(
        self, subject: int, height_m: float, num_points: int = DEFAULT_NUM_POINTS, echo: SkinEcho | None = None
    ):
        self.echo = echo or SkinEcho()
        self.scale = height_m / REFERENCE_HEIGHT_M
        self.height_m = height_m
        self._posed: tuple[bytes, tuple[np.ndarray, np.ndarray, np.ndarray]] | None = None
        rng = stream(subject, "body", num_points)
        area = np.array([self._side_area(capsule) for capsule in CAPSULES])
        self.part = np.sort(rng.choice(len(CAPSULES), size=num_points, p=area / area.sum()))
        # Uniform over the sides and, by Archimedes, over the round caps.
        caps = np.array([_cap_shares(c) for c in CAPSULES])[self.part]
        self.along = rng.random(num_points) * (1 + caps.sum(axis=1)) - caps[:, 0]
        over = self.along - np.clip(self.along, 0.0, 1.0)
        self.cap_sine = over / np.maximum(np.where(over < 0, caps[:, 0], caps[:, 1]), 1e-9)
        self.angle_rad = rng.uniform(0, 2 * np.pi, num_points)
        self.micro_phase = np.exp(2j * np.pi * rng.random(num_points))
        self.area_m2 = area.sum() * self.scale**2 / num_points
        limb_db = [_limb_db(capsule, self.echo) for capsule in CAPSULES]
        self.brightness = 10 ** (np.array(limb_db)[self.part] / 10)  # (point,) in power

    @staticmethod
    def _side_area(capsule: Capsule) -> float:
        radius = (capsule.start_radius_m + capsule.end_radius_m) / 2
        return 2 * np.pi * radius * _length_m(capsule) * (1 + sum(_cap_shares(capsule)))

    @cached_property
    def radii_m(self) -> np.ndarray:
        """(capsule, 2)."""
        return np.array([(c.start_radius_m, c.end_radius_m) for c in CAPSULES]) * self.scale

    @cached_property
    def _taper(self) -> np.ndarray:
        """How fast each capsule's radius grows along it."""
        grows = [(c.end_radius_m - c.start_radius_m) / _length_m(c) if c.start != c.end else 0.0 for c in CAPSULES]
        return np.array(grows)

    @cached_property
    def widths(self) -> np.ndarray:
        """(capsule,) how much wider than deep each is."""
        return np.array([TORSO_WIDTH_FRONT if c.start in TORSO else 1.0 for c in CAPSULES])

    def frames(self, joints_m: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Capsule starts (time, capsule, 3), axes as vectors start -> end, and rotations (time, capsule, 3, 3).

        A rotation's columns are the capsule's right, front and along directions in the radar's frame. Skin and shadow
        ask for the same poses: the last ones are kept.
        """
        asked, kept = joints_m.tobytes(), self._posed
        if kept is None or kept[0] != asked:
            kept = self._posed = asked, self._frames(joints_m)
        return kept[1]

    def _frames(self, joints_m: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        torso = _torso_rotation(joints_m)
        starts, axes, rotations = [], [], []
        for capsule in CAPSULES:
            start = joints_m[:, joint(capsule.start)]
            end = joints_m[:, joint(capsule.end)]
            bone = start - joints_m[:, joint(CONTINUES[capsule.start])] if capsule.start in CONTINUES else end - start
            if capsule.start == capsule.end and capsule.start not in CONTINUES:  # the hips: a lump about the joint
                bone = -torso[:, :, 2]
            length = np.linalg.norm(bone, axis=-1, keepdims=True)
            unit = bone / np.maximum(length, 1e-9)
            own = np.linalg.norm(end - start, axis=-1, keepdims=True)
            starts.append(start)
            axes.append(unit * (own + capsule.extend_m * self.scale))
            rotations.append(_shortest_turn(torso, np.asarray(capsule.rest), unit))
        return np.stack(starts, 1), np.stack(axes, 1), np.stack(rotations, 1)

    @cached_property
    def _breathes(self) -> np.ndarray:
        """How far each point follows the chest's front: all of it in front, a little at the sides and back."""
        share = np.array([CHEST.get(capsule.start, 0.0) for capsule in CAPSULES])[self.part]
        front = np.maximum(np.sin(self.angle_rad), 0.0)
        return share * (CHEST_BACK + (1 - CHEST_BACK) * front)

    def skin(self, joints_m: np.ndarray, chest_m: np.ndarray | None = None) -> Skin:
        """Skin points for joints (time, 22, 3); `chest_m` (time,) is how far the chest's front stands out."""
        starts, axes, rotations = self.frames(joints_m)
        part, radii = self.part, self.radii_m
        along = np.clip(self.along, 0.0, 1.0)
        radius = radii[part, 0] + (radii[part, 1] - radii[part, 0]) * along
        ring = np.sqrt(1 - self.cap_sine**2)
        local = np.stack([np.cos(self.angle_rad) * ring, np.sin(self.angle_rad) * ring, self.cap_sine], -1)
        width = self.widths[part]
        offset = local * radius[:, None]
        offset[:, 0] *= width
        normal = local.copy()
        normal[:, 0] /= width
        normal[:, 2] -= self._taper[part] * (self.cap_sine == 0)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        turn = rotations[:, part]
        place = starts[:, part] + axes[:, part] * along[None, :, None] + np.einsum("tpij,pj->tpi", turn, offset)
        outward = np.einsum("tpij,pj->tpi", turn, normal)
        if chest_m is not None:
            trunk = np.flatnonzero(self._breathes)
            place[:, trunk] += outward[:, trunk] * (chest_m[:, None] * self._breathes[trunk])[..., None]
        return Skin(place_m=place, normal=outward)

    def hull(self, joints_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Low-poly hull of all capsules for shadows: vertices (time, vertex, 3) and faces (face, 3)."""
        starts, axes, rotations = self.frames(joints_m)
        turns = np.arange(RING) * 2 * np.pi / RING
        circle = np.stack([np.cos(turns), np.sin(turns), np.zeros(RING)], -1)
        rings = []
        for end in (0, 1):
            offset = circle[None] * self.radii_m[:, end, None, None]
            offset[..., 0] *= self.widths[:, None]
            centre = starts + axes * end
            rings.append(centre[:, :, None] + np.einsum("tcij,crj->tcri", rotations, offset))
        reach = self.radii_m * np.array([-1.0, 1.0])
        tips = [
            starts + axes * end + rotations[..., 2] * reach[None, :, end, None] for end in (0, 1)
        ]  # fmt: skip
        vertices = np.concatenate([*rings, tips[0][:, :, None], tips[1][:, :, None]], axis=2)
        return vertices.reshape(len(joints_m), -1, 3), _capsule_faces(len(CAPSULES))


# Bone lengths that only set how many points each part gets.
NOMINAL_LENGTH_M = {
    ("pelvis", "spine1"): 0.12, ("spine1", "spine2"): 0.13, ("spine2", "spine3"): 0.06, ("spine3", "neck"): 0.2,
    ("neck", "head"): 0.1, ("left_hip", "left_knee"): 0.4, ("right_hip", "right_knee"): 0.4,
    ("left_knee", "left_ankle"): 0.4, ("right_knee", "right_ankle"): 0.4, ("left_ankle", "left_foot"): 0.14,
    ("right_ankle", "right_foot"): 0.14, ("left_shoulder", "left_elbow"): 0.26, ("right_shoulder", "right_elbow"): 0.26,
    ("left_elbow", "left_wrist"): 0.25, ("right_elbow", "right_wrist"): 0.25, ("left_collar", "left_shoulder"): 0.12,
    ("right_collar", "right_shoulder"): 0.12, ("left_wrist", "left_wrist"): 0.02, ("right_wrist", "right_wrist"): 0.02,
    ("head", "head"): 0.05,
}  # fmt: skip


def _length_m(capsule: Capsule) -> float:
    return NOMINAL_LENGTH_M.get((capsule.start, capsule.end), 0.02) + capsule.extend_m


def _cap_shares(capsule: Capsule) -> tuple[float, float]:
    """Length of the round caps at start and end relative to the side; only free ends have skin on them."""
    share = capsule.end_radius_m / _length_m(capsule) if capsule.extend_m else 0.0
    is_lump = capsule.start == capsule.end and capsule.start not in CONTINUES
    return (share if is_lump else 0.0, share)


def _limb_db(capsule: Capsule, echo: SkinEcho) -> float:
    """How much brighter than the trunk a capsule is."""
    start, end = (name.rsplit("_", 1)[-1] for name in (capsule.start, capsule.end))
    if end in ("elbow", "wrist"):
        return echo.arms_db
    return echo.legs_db if end in ("knee", "ankle", "foot") and start != end else 0.0


def _torso_rotation(joints_m: np.ndarray) -> np.ndarray:
    """(time, 3, 3), columns right, front, up of the trunk."""
    right = joints_m[:, joint("right_hip")] - joints_m[:, joint("left_hip")]
    right = right + joints_m[:, joint("right_shoulder")] - joints_m[:, joint("left_shoulder")]
    up = joints_m[:, joint("neck")] - joints_m[:, joint("pelvis")]
    up = up / np.linalg.norm(up, axis=-1, keepdims=True)
    right = right - (right * up).sum(-1, keepdims=True) * up
    right = right / np.linalg.norm(right, axis=-1, keepdims=True)
    return np.stack([right, _cross(up, right), up], axis=-1)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The cross product (..., 3), as numpy's own and five times quicker for few vectors."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i] = a[..., j] * b[..., k] - a[..., k] * b[..., j]
    return out


def _shortest_turn(torso: np.ndarray, rest: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """Rotations whose third column is `unit`, turned the shortest way from the rest direction within the trunk.

    Turning the shortest way keeps skin from spinning about its bone, which a radar would see as velocity.
    """
    rest = rest / np.linalg.norm(rest)
    helper = np.array([0.0, 1.0, 0.0]) if abs(rest[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    across = _cross(helper, rest)
    across /= np.linalg.norm(across)
    start = torso @ np.stack([across, _cross(rest, across), rest], axis=-1)
    old = start[..., 2]
    axis = _cross(old, unit)
    cos = (old * unit).sum(-1)[..., None]
    moved = [start[..., i] for i in range(2)]
    turned = [
        v * cos + _cross(axis, v) + axis * (axis * v).sum(-1, keepdims=True) / np.maximum(1 + cos, 1e-3) for v in moved
    ]
    return np.stack([*turned, unit], axis=-1)


def _capsule_faces(count: int) -> np.ndarray:
    """Faces of `count` hulls of 2 rings and 2 tips each."""
    a = np.arange(RING)
    b = (a + 1) % RING
    sides = np.concatenate([np.stack([a, b, b + RING], 1), np.stack([a, b + RING, a + RING], 1)])
    lower = np.stack([a, b, np.full(RING, 2 * RING)], 1)
    upper = np.stack([a + RING, b + RING, np.full(RING, 2 * RING + 1)], 1)
    one = np.concatenate([sides, lower, upper])
    return (one[None] + np.arange(count)[:, None, None] * (2 * RING + 2)).reshape(-1, 3)


def body_of(pose: PoseSequence, num_points: int = DEFAULT_NUM_POINTS, echo: SkinEcho | None = None) -> ScatteringBody:
    """The body that a pose sequence moves."""
    return ScatteringBody(pose.subject, pose.height_m, num_points, echo)


@lru_cache(maxsize=1)
def average_body() -> ScatteringBody:
    """A person of average height with a surface that belongs to no subject."""
    return ScatteringBody(AVERAGE_SUBJECT, REFERENCE_HEIGHT_M, AVERAGE_NUM_POINTS)
