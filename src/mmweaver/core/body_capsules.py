"""The human body as capsules around the bones of the 22-joint skeleton: the single table of body shape.

Skin points and occlusion, separation of people and collision tests of placed motions all take their radii from
`CAPSULES`. Sizes apply to a person of `REFERENCE_HEIGHT_M` and scale with height.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.rotations import unit
from mmweaver.core.skeleton import joint

Array = np.ndarray
REFERENCE_HEIGHT_M = 1.75
TRUNK_WIDTH_PER_DEPTH = 1.25  # the trunk's cross-section is an ellipse, wider than deep
TRUNK = ("pelvis", "spine1", "spine2", "spine3")  # start joints of the trunk's capsules
# A capsule whose start and end are the same joint continues the preceding bone: hand - forearm, crown - neck.
CONTINUED_FROM = {"head": "neck", "left_wrist": "left_elbow", "right_wrist": "right_elbow"}
HULL_CORNERS = 6  # corners of a ring of the low-poly hull

_PAIRED = {"hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist"}
_DOWN, _UP, _FRONT = (0.0, 0.0, -1.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
_ARM = (0.45, 0.45, -0.77)  # the opposite, behind and above the other shoulder, is out of reach
_LUMP_LENGTH_M = 0.02  # length before extension if start and end are the same joint
# Typical bone lengths by distal joint.
_BONE_LENGTH_M = {
    "spine1": 0.12,
    "spine2": 0.13,
    "spine3": 0.06,
    "neck": 0.2,
    "head": 0.1,
    "knee": 0.4,
    "ankle": 0.4,
    "foot": 0.14,
    "shoulder": 0.12,
    "elbow": 0.26,
    "wrist": 0.25,
}


@dataclass(frozen=True, kw_only=True)
class Capsule:
    """A body part from joint to joint (or beyond), with a radius at either end; sizes at reference height."""

    start: str
    end: str
    start_radius_m: float
    end_radius_m: float
    rest: tuple[float, float, float]  # rest direction in the trunk's frame (right, front, up)
    extend_m: float = 0.0  # beyond the end joint: hands, toes, crown of the head

    @property
    def is_lump(self) -> bool:
        """Whether it surrounds a single joint without continuing a bone (the hips)."""
        return self.start == self.end and self.start not in CONTINUED_FROM

    @property
    def typical_length_m(self) -> float:
        """Axis length in metres at reference height; posed capsules follow their joints instead."""
        if self.start == self.end:
            return (0.05 if self.start == "head" else _LUMP_LENGTH_M) + self.extend_m
        return _BONE_LENGTH_M[part_of(self.end)] + self.extend_m

    @property
    def width_per_depth(self) -> float:
        """Ratio of width to depth of the elliptic cross-section."""
        return TRUNK_WIDTH_PER_DEPTH if self.start in TRUNK else 1.0


def part_of(joint_name: str) -> str:
    """Strips the side from a joint name.

    Args:
        joint_name: Name in `skeleton.JOINT_NAMES`.

    Returns:
        Name without "left_" or "right_".

    >>> part_of("left_knee"), part_of("neck")
    ('knee', 'neck')
    """
    return joint_name.removeprefix("left_").removeprefix("right_")


def _pair(
    start: str, end: str, radii_m: tuple[float, float], rest: tuple[float, float, float], extend_m: float = 0.0
) -> list[Capsule]:
    """The left and the right capsule of a pair; `rest` is the right one's."""
    return [
        Capsule(
            start=f"{side}_{start}" if start in _PAIRED else start,
            end=f"{side}_{end}",
            start_radius_m=radii_m[0],
            end_radius_m=radii_m[1],
            rest=(sign * rest[0], rest[1], rest[2]),
            extend_m=extend_m,
        )
        for side, sign in (("left", -1.0), ("right", 1.0))
    ]


CAPSULES: tuple[Capsule, ...] = (
    Capsule(start="pelvis", end="spine1", start_radius_m=0.125, end_radius_m=0.115, rest=_UP),
    Capsule(start="spine1", end="spine2", start_radius_m=0.115, end_radius_m=0.115, rest=_UP),
    Capsule(start="spine2", end="spine3", start_radius_m=0.115, end_radius_m=0.125, rest=_UP),
    Capsule(start="spine3", end="neck", start_radius_m=0.12, end_radius_m=0.06, rest=_UP),
    Capsule(start="neck", end="head", start_radius_m=0.055, end_radius_m=0.075, rest=_UP),
    Capsule(start="head", end="head", start_radius_m=0.085, end_radius_m=0.095, rest=_UP, extend_m=0.10),
    *_pair("hip", "hip", (0.105, 0.105), _DOWN, 0.02),
    *_pair("collar", "shoulder", (0.07, 0.06), (1.0, 0.0, 0.0)),
    *_pair("hip", "knee", (0.085, 0.058), _DOWN),
    *_pair("knee", "ankle", (0.055, 0.038), _DOWN),
    *_pair("ankle", "foot", (0.038, 0.035), _FRONT, 0.05),
    *_pair("shoulder", "elbow", (0.05, 0.042), _ARM),
    *_pair("elbow", "wrist", (0.042, 0.03), _ARM),
    *_pair("wrist", "wrist", (0.042, 0.04), _ARM, 0.12),
)
_BY_ENDS = {(capsule.start, capsule.end): capsule for capsule in CAPSULES}


def capsule_between(start: str, end: str) -> Capsule:
    """Looks up the capsule of a bone, or of a single joint if both names are equal.

    Args:
        start: Proximal joint.
        end: Distal joint.

    Returns:
        The capsule at reference height.

    >>> capsule_between("left_knee", "left_ankle").start_radius_m
    0.055
    """
    return _BY_ENDS[start, end]


def scale_of(height_m: float) -> float:
    """Scale from the sizes in `CAPSULES` to a person of `height_m`."""
    return height_m / REFERENCE_HEIGHT_M


def radii_m(height_m: float, girth: float = 1.0) -> Float[Array, "capsule 2"]:
    """Radii of all capsules; half the depth where the cross-section is elliptic.

    Args:
        height_m: Body height in metres.
        girth: Thickness relative to the average body of this height; the head always has average size. Default: 1.

    Returns:
        Radii at start and end in metres, (capsule, 2).
    """
    wider = np.array([1.0 if "head" in (c.start, c.end) else girth for c in CAPSULES])
    return np.array([(c.start_radius_m, c.end_radius_m) for c in CAPSULES]) * scale_of(height_m) * wider[:, None]


def widths_per_depth() -> Float[Array, " capsule"]:
    """Ratio of width to depth of each capsule's cross-section, (capsule,)."""
    return np.array([capsule.width_per_depth for capsule in CAPSULES])


@dataclass(frozen=True, kw_only=True)
class PosedCapsules:
    """Axes of all capsules over time, in the frame of the joints.

    Attributes:
        start_m: Start of each axis, metres.
        axis_m: Vector from start to end, metres.
        rotation: Columns are the capsule's right, front and axial directions.
    """

    start_m: Float[Array, "time capsule 3"]
    axis_m: Float[Array, "time capsule 3"]
    rotation: Float[Array, "time capsule 3 3"]


def pose_capsules(joints_m: Float[Array, "time 22 3"], height_m: float) -> PosedCapsules:
    """Places the capsules on a moving skeleton.

    Args:
        joints_m: Joints in metres, (time, 22, 3).
        height_m: Body height in metres.

    Returns:
        Capsule axes and orientations in the frame of the joints.
    """
    trunk = _trunk_rotation(joints_m)
    start, end = joints_m[:, _START], joints_m[:, _END]
    bone = joints_m[:, _TO] - joints_m[:, _FROM]
    bone[:, _LUMPS] = -trunk[:, None, :, 2]
    along = unit(bone)
    own = np.linalg.norm(end - start, axis=-1, keepdims=True)
    return PosedCapsules(
        start_m=start,
        axis_m=along * (own + _EXTEND_M[:, None] * scale_of(height_m)),
        rotation=_shortest_rotations(trunk, along),
    )


def hull(
    posed: PosedCapsules, height_m: float, girth: float = 1.0
) -> tuple[Float[Array, "time vertex 3"], Int[Array, "face 3"]]:
    """Builds a low-poly hull of all capsules.

    Args:
        posed: Capsules, (time, capsule).
        height_m: Body height in metres.
        girth: Thickness relative to the average body of this height. Default: 1.

    Returns:
        Vertices in metres, (time, vertex, 3), and faces common to all times, (face, 3).
    """
    angles = np.arange(HULL_CORNERS) * 2 * np.pi / HULL_CORNERS
    circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(HULL_CORNERS)], -1)
    radii, widths = radii_m(height_m, girth), widths_per_depth()
    rings = []
    for end in (0, 1):
        offset = circle[None] * radii[:, end, None, None]
        offset[..., 0] *= widths[:, None]
        centre = posed.start_m + posed.axis_m * end
        rings.append(centre[:, :, None] + np.einsum("tcij,crj->tcri", posed.rotation, offset))
    reach = radii * np.array([-1.0, 1.0])
    tips = [posed.start_m + posed.axis_m * end + posed.rotation[..., 2] * reach[None, :, end, None] for end in (0, 1)]
    vertices = np.concatenate([*rings, tips[0][:, :, None], tips[1][:, :, None]], axis=2)
    return vertices.reshape(len(posed.start_m), -1, 3), _hull_faces(len(CAPSULES))


def _hull_faces(count: int) -> Int[Array, "face 3"]:
    """Faces of `count` hulls with two rings and two tips each."""
    a = np.arange(HULL_CORNERS)
    b = (a + 1) % HULL_CORNERS
    sides = np.concatenate(
        [np.stack([a, b, b + HULL_CORNERS], 1), np.stack([a, b + HULL_CORNERS, a + HULL_CORNERS], 1)]
    )
    lower = np.stack([a, b, np.full(HULL_CORNERS, 2 * HULL_CORNERS)], 1)
    upper = np.stack([a + HULL_CORNERS, b + HULL_CORNERS, np.full(HULL_CORNERS, 2 * HULL_CORNERS + 1)], 1)
    one = np.concatenate([sides, lower, upper])
    return (one[None] + np.arange(count)[:, None, None] * (2 * HULL_CORNERS + 2)).reshape(-1, 3)


def _trunk_rotation(joints_m: Float[Array, "time 22 3"]) -> Float[Array, "time 3 3"]:
    """Rotations whose columns are the trunk's right, front and up directions."""
    right = joints_m[:, joint("right_hip")] - joints_m[:, joint("left_hip")]
    right = right + joints_m[:, joint("right_shoulder")] - joints_m[:, joint("left_shoulder")]
    up = unit(joints_m[:, joint("neck")] - joints_m[:, joint("pelvis")])
    right = unit(right - (right * up).sum(-1, keepdims=True) * up)
    return np.stack([right, _cross(up, right), up], axis=-1)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross product (..., 3); equals np.cross and is five times as fast for few vectors."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i] = a[..., j] * b[..., k] - a[..., k] * b[..., j]
    return out


def _rest_frame(rest: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Frame in the trunk whose third column is a capsule's rest direction."""
    rest = unit(rest)
    not_along = np.array([0.0, 1.0, 0.0]) if abs(rest[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    across = unit(_cross(not_along, rest))
    return np.stack([across, _cross(rest, across), rest], axis=-1)


def _shortest_rotations(
    trunk: Float[Array, "time 3 3"], along: Float[Array, "time capsule 3"]
) -> Float[Array, "time capsule 3 3"]:
    """Rotations with third column `along`, reached by the shortest rotation from the rest direction in the trunk.

    The shortest rotation keeps skin from spinning about its bone, which would add spurious Doppler.
    """
    start = trunk[:, None] @ _REST_FRAMES
    old = start[..., 2]
    axis = _cross(old, along)
    cos = (old * along).sum(-1, keepdims=True)
    less = axis / np.maximum(1 + cos, 1e-3)
    rotated = [
        v * cos + _cross(axis, v) + less * (axis * v).sum(-1, keepdims=True) for v in (start[..., 0], start[..., 1])
    ]
    return np.stack([*rotated, along], axis=-1)


_REST_FRAMES = np.stack([_rest_frame(np.asarray(one.rest)) for one in CAPSULES])
_START, _END = [joint(one.start) for one in CAPSULES], [joint(one.end) for one in CAPSULES]
# Joints that define a capsule's direction: its own, or those of the bone it continues.
_FROM = [joint(CONTINUED_FROM.get(one.start, one.start)) for one in CAPSULES]
_TO = [joint(one.start if one.start in CONTINUED_FROM else one.end) for one in CAPSULES]
_LUMPS = [number for number, one in enumerate(CAPSULES) if one.is_lump]
_EXTEND_M = np.array([one.extend_m for one in CAPSULES])
