"""A person as the radar sees one: capsules around the bones, points on their skin that ride along.

The points and their micro-phases belong to the subject, not to the sequence: the same person in another motion has
the same skin. Reference: physics of published 77 GHz body models, docs/radar_primer.md, section 4.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from mmweaver.core.body_capsules import (
    CAPSULES,
    REFERENCE_HEIGHT_M,
    Capsule,
    PosedCapsules,
    hull,
    part_of,
    pose_capsules,
    radii_m,
    scale_of,
    widths_per_depth,
)
from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.propagation.skin_scattering import SkinEcho

AVERAGE_SUBJECT, AVERAGE_NUM_POINTS = 90_000, 600  # the average body, no subject of a generated sequence
DEFAULT_NUM_POINTS = 800
CHEST = {"pelvis": 0.3, "spine1": 0.7, "spine2": 1.0, "spine3": 0.8}  # how far each part of the trunk breathes
CHEST_BACK = 0.15  # and its back, of its front
# how fast each capsule's radius grows along it
TAPER = np.array([(c.end_radius_m - c.start_radius_m) / c.typical_length_m * (c.start != c.end) for c in CAPSULES])


@dataclass(frozen=True, kw_only=True)
class Skin:
    """Points of a body at some times: place and outward normal (time, point, 3)."""

    place_m: np.ndarray
    normal: np.ndarray


class ScatteringBody:
    """One subject's skin points on its capsules; `skin` and `hull` pose them."""

    def __init__(
        self,
        subject: int,
        height_m: float,
        num_points: int = DEFAULT_NUM_POINTS,
        echo: SkinEcho | None = None,
        girth: float = 1.0,
    ):
        self.echo = echo or SkinEcho()
        self.height_m, self.girth = height_m, girth
        self.radii_m = radii_m(height_m, girth)  # (capsule, 2)
        self.widths = widths_per_depth()  # (capsule,) how much wider than deep each is
        self._posed: tuple[bytes, PosedCapsules] | None = None
        rng = stream(subject, "body", num_points)
        area = np.array([_side_area(capsule) for capsule in CAPSULES])
        self.part = np.sort(rng.choice(len(CAPSULES), size=num_points, p=area / area.sum()))
        # Uniform over the sides and, by Archimedes, over the round caps.
        caps = np.array([_cap_shares(c) for c in CAPSULES])[self.part]
        self.along = rng.random(num_points) * (1 + caps.sum(axis=1)) - caps[:, 0]
        over = self.along - np.clip(self.along, 0.0, 1.0)
        self.cap_sine = over / np.maximum(np.where(over < 0, caps[:, 0], caps[:, 1]), 1e-9)
        self.angle_rad = rng.uniform(0, 2 * np.pi, num_points)
        self.micro_phase = np.exp(2j * np.pi * rng.random(num_points))
        self.area_m2 = area.sum() * scale_of(height_m) ** 2 * girth / num_points
        limb_db = [_limb_db(capsule, self.echo) for capsule in CAPSULES]
        self.brightness = 10 ** (np.array(limb_db)[self.part] / 10)  # (point,) in power

    def posed(self, joints_m: np.ndarray) -> PosedCapsules:
        """The capsules for joints (time, 22, 3); the last ones are kept, for skin and occlusion ask for the same."""
        asked, kept = joints_m.tobytes(), self._posed
        if kept is None or kept[0] != asked:
            kept = self._posed = asked, pose_capsules(joints_m, self.height_m)
        return kept[1]

    @cached_property
    def _breathes(self) -> np.ndarray:
        """How far each point follows the chest's front: all of it in front, a little at the sides and back."""
        share = np.array([CHEST.get(capsule.start, 0.0) for capsule in CAPSULES])[self.part]
        front = np.maximum(np.sin(self.angle_rad), 0.0)
        return share * (CHEST_BACK + (1 - CHEST_BACK) * front)

    def skin(self, joints_m: np.ndarray, chest_m: np.ndarray | None = None) -> Skin:
        """Skin points for joints (time, 22, 3); `chest_m` (time,) is how far the chest's front stands out."""
        posed = self.posed(joints_m)
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
        normal[:, 2] -= TAPER[part] * (self.cap_sine == 0)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        rotation = posed.rotation[:, part]
        axis_points = posed.start_m[:, part] + posed.axis_m[:, part] * along[None, :, None]
        place = axis_points + np.einsum("tpij,pj->tpi", rotation, offset)
        outward = np.einsum("tpij,pj->tpi", rotation, normal)
        if chest_m is not None:
            trunk = np.flatnonzero(self._breathes)
            place[:, trunk] += outward[:, trunk] * (chest_m[:, None] * self._breathes[trunk])[..., None]
        return Skin(place_m=place, normal=outward)

    def hull(self, joints_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Low-poly hull of all capsules for occlusion: vertices (time, vertex, 3) and faces (face, 3)."""
        return hull(self.posed(joints_m), self.height_m, self.girth)


def _side_area(capsule: Capsule) -> float:
    radius = (capsule.start_radius_m + capsule.end_radius_m) / 2
    return 2 * np.pi * radius * capsule.typical_length_m * (1 + sum(_cap_shares(capsule)))


def _cap_shares(capsule: Capsule) -> tuple[float, float]:
    """Length of the round caps at start and end relative to the side; only free ends have skin on them."""
    share = capsule.end_radius_m / capsule.typical_length_m if capsule.extend_m else 0.0
    return (share if capsule.is_lump else 0.0, share)


def _limb_db(capsule: Capsule, echo: SkinEcho) -> float:
    """How much brighter than the trunk a capsule is."""
    start, end = part_of(capsule.start), part_of(capsule.end)
    if end in ("elbow", "wrist"):
        return echo.arms_db
    return echo.legs_db if end in ("knee", "ankle", "foot") and start != end else 0.0


def body_of(pose: PoseSequence, num_points: int = DEFAULT_NUM_POINTS, echo: SkinEcho | None = None) -> ScatteringBody:
    """The body that a pose sequence moves."""
    return ScatteringBody(pose.subject, pose.height_m, num_points, echo, pose.girth)


@lru_cache(maxsize=1)
def average_body() -> ScatteringBody:
    """A person of average height with a surface that belongs to no subject."""
    return ScatteringBody(AVERAGE_SUBJECT, REFERENCE_HEIGHT_M, AVERAGE_NUM_POINTS)
