"""A person as the radar sees one: capsules around the bones, and scattering points on their surface.

Points and micro-phases belong to the subject, not to the sequence: the same person has the same skin in every motion.
Reference: published 77 GHz body models, docs/radar_primer.md, section 4.
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

AVERAGE_SUBJECT, AVERAGE_NUM_POINTS = 90_000, 600  # the average body, which no generated sequence uses
DEFAULT_NUM_POINTS = 800
# how far each part of the trunk follows the front of the chest and of the belly
CHEST = {"spine1": 0.3, "spine2": 1.0, "spine3": 0.8}
BELLY = {"pelvis": 0.5, "spine1": 0.8}
CHEST_BACK = 0.15  # breathing amplitude of the back relative to the front
# slope of each capsule's radius along its axis
TAPER = np.array([(c.end_radius_m - c.start_radius_m) / c.typical_length_m * (c.start != c.end) for c in CAPSULES])


@dataclass(frozen=True, kw_only=True)
class Skin:
    """Skin points of a body over time.

    Attributes:
        place_m: Positions (time, point, 3) in metres.
        normal: Outward unit normals (time, point, 3).
    """

    place_m: np.ndarray
    normal: np.ndarray


class ScatteringBody:
    """The skin points of one subject on its capsules; `skin` and `hull` pose them."""

    def __init__(
        self,
        subject: int,
        height_m: float,
        num_points: int = DEFAULT_NUM_POINTS,
        echo: SkinEcho | None = None,
        girth: float = 1.0,
    ):
        """Samples the skin points of a subject.

        Args:
            subject: Number of the person, which seeds points and micro-phases.
            height_m: Body height in metres.
            num_points: Number of skin points.
            echo: How skin scatters; by default `SkinEcho()`.
            girth: Circumference relative to a person of average build.
        """
        self.echo = echo or SkinEcho()
        self.height_m, self.girth = height_m, girth
        self.radii_m = radii_m(height_m, girth)  # (capsule, 2)
        self.widths = widths_per_depth()  # (capsule,) width over depth
        self._posed: tuple[bytes, PosedCapsules] | None = None
        rng = stream(subject, "body", num_points)
        area = np.array([_side_area(capsule) for capsule in CAPSULES])
        self.part = np.sort(rng.choice(len(CAPSULES), size=num_points, p=area / area.sum()))
        # Uniform over the sides and, by Archimedes' hat-box theorem, over the round caps.
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
        """The capsules for joints (time, 22, 3). The last result is kept: skin and occlusion use the same joints."""
        asked, kept = joints_m.tobytes(), self._posed
        if kept is None or kept[0] != asked:
            kept = self._posed = asked, pose_capsules(joints_m, self.height_m)
        return kept[1]

    @cached_property
    def _breathes(self) -> np.ndarray:
        """Share (point, 2) of the displacements of chest and belly: 1 in front, small at the sides and back."""
        share = np.array([[part.get(one.start, 0.0) for part in (CHEST, BELLY)] for one in CAPSULES])[self.part]
        front = np.maximum(np.sin(self.angle_rad), 0.0)
        return share * (CHEST_BACK + (1 - CHEST_BACK) * front)[:, None]

    def skin(self, joints_m: np.ndarray, trunk_m: np.ndarray | None = None) -> Skin:
        """Poses the skin points.

        Args:
            joints_m: Joints (time, 22, 3) in metres.
            trunk_m: Outward displacement of the fronts of chest and belly (time, 2) in metres; by default none.

        Returns:
            Positions and normals of the skin points.
        """
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
        if trunk_m is not None:
            trunk = np.flatnonzero(self._breathes.any(axis=1))
            place[:, trunk] += outward[:, trunk] * (trunk_m @ self._breathes[trunk].T)[..., None]
        return Skin(place_m=place, normal=outward)

    def hull(self, joints_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses a low-poly hull of all capsules, for occlusion.

        Args:
            joints_m: Joints (time, 22, 3) in metres.

        Returns:
            Vertices (time, vertex, 3) in metres and faces (face, 3).
        """
        return hull(self.posed(joints_m), self.height_m, self.girth)


def _side_area(capsule: Capsule) -> float:
    radius = (capsule.start_radius_m + capsule.end_radius_m) / 2
    return 2 * np.pi * radius * capsule.typical_length_m * (1 + sum(_cap_shares(capsule)))


def _cap_shares(capsule: Capsule) -> tuple[float, float]:
    """Length of the round caps at start and end relative to the side; only free ends are capped."""
    share = capsule.end_radius_m / capsule.typical_length_m if capsule.extend_m else 0.0
    return (share if capsule.is_lump else 0.0, share)


def _limb_db(capsule: Capsule, echo: SkinEcho) -> float:
    """Brightness of a capsule relative to the trunk, in dB."""
    start, end = part_of(capsule.start), part_of(capsule.end)
    if end in ("elbow", "wrist"):
        return echo.arms_db
    return echo.legs_db if end in ("knee", "ankle", "foot") and start != end else 0.0


def body_of(pose: PoseSequence, num_points: int = DEFAULT_NUM_POINTS, echo: SkinEcho | None = None) -> ScatteringBody:
    """The scattering body of the person in a pose sequence.

    Args:
        pose: Motion of one person, for its subject, height and girth.
        num_points: Number of skin points.
        echo: How skin scatters; by default `SkinEcho()`.
    """
    body = ScatteringBody(pose.subject, pose.height_m, num_points, echo, pose.girth)
    body.brightness = body.brightness * 10 ** (-pose.cover_db / 10)
    return body


@lru_cache(maxsize=1)
def average_body() -> ScatteringBody:
    """A person of average height, with skin points that belong to no subject."""
    return ScatteringBody(AVERAGE_SUBJECT, REFERENCE_HEIGHT_M, AVERAGE_NUM_POINTS)
